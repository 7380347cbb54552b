// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/errors.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr double number = sizeof(double);
constexpr double entry = sizeof(double) + sizeof(int);

double square(double n) { return n * n; }

/// Each shape's matrix, and those of the kinds, condensed.
double shapes(const PlateProblem& problem) {
  const auto n_modes = static_cast<double>(problem.numbering.function.rows());
  const auto n = static_cast<double>(problem.elements.congruent.first.size() + problem.elements.kinds.size());
  return n * square(2 * n_modes) * number;
}

}  // namespace

MemoryNeed memory_need(const PlateProblem& problem, const Outline& outline, const Eigen::VectorXi& p, Wanted wanted) {
  const auto rows = outline.rows(p[p.size() - 1]);
  const Outline::Size size = outline.size(rows);
  const auto nc = static_cast<double>(problem.unknowns.n_controlled);
  const auto h = static_cast<double>(problem.friction_hole.size());
  const auto q = static_cast<double>(problem.unknowns.traction.size());
  const auto n_p = [&](Eigen::Index level) {
    return static_cast<double>(problem.unknowns.n_free[static_cast<std::size_t>(p[level])]);
  };
  const double rows_of_E = static_cast<double>(p.size()) * (nc + h) * nc;
  const bool with_fields = wanted == Wanted::loads_and_stresses;
  const double of_last = n_p(p.size() - 1) * (q + 2 + (with_fields ? nc + h : 0));
  const double before = p.size() > 1 && with_fields ? n_p(p.size() - 2) * (nc + h) : 0;
  // The file is built in memory, which grows there by copying, and copied once more before it is written.
  const double fields = 4 * (of_last + before) + 3 * rows_of_E;
  constexpr double libraries = 24e6;
  return {shapes(problem), 2 * entry * size.entries + number * (size.factor + size.largest_front), number * fields,
          libraries};
}

void require_memory(const PlateScene& scene, const MemoryNeed& need, double available) {
  if (need.total() <= available) return;
  throw InputError(
      fmt::format("{}: at p = {} this takes about {} of memory (shapes {}, factor {}, fields and file {}), {} are "
                  "available; allowed: a lower p{}, or fewer holes",
                  scene.file, scene.p_high, bytes_text(need.total()), bytes_text(need.shapes), bytes_text(need.factor),
                  bytes_text(need.fields), bytes_text(available),
                  need.fields > need.factor ? ", --loads-only, which needs no fields" : ""));
}

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

}  // namespace fastjoint::stage1
