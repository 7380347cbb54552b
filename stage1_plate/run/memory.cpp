// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/count.hpp"
#include "common/program/memory.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr double number = sizeof(double);
constexpr double entry = sizeof(double) + sizeof(int);

double square(double n) { return n * n; }

/// Matrices of the congruence classes at the highest degree, and the condensed ones of the classes at degree p alone.
double element_matrices(const PlateProblem& problem, int p) {
  const auto& numbering = problem.numbering;
  double entries = count_of(problem.elements.congruent.first) * square(2.0 * double(numbering.function.rows()));
  for (const auto& each : problem.elements.classes)
    entries += square(2.0 * double((numbering.function.col(each.first).array() < numbering.n_functions[p]).count()));
  return entries * number;
}

}  // namespace

MemoryNeed memory_need(const PlateProblem& problem, const Skeleton& skeleton, const Eigen::VectorXi& p, Wanted wanted,
                       int n_rim) {
  const auto rows = skeleton.rows(problem, p[p.size() - 1]);
  const Skeleton::Size size = skeleton.size(rows);
  const double nc = problem.unknowns.n_controlled, h = count_of(problem.friction_hole);
  const double q = count_of(problem.unknowns.traction), r = n_rim;
  const auto n_p = [&](Eigen::Index level) -> double { return problem.unknowns.n_free[p[level]]; };
  const double rows_of_E = count_of(p) * (nc + h) * nc;
  const bool with_fields = wanted == Wanted::loads_and_stresses;
  const double of_last = n_p(p.size() - 1) * (q + 2 + (with_fields ? nc + h : 0));
  const double before = p.size() > 1 && with_fields ? n_p(p.size() - 2) * (nc + h) : 0;
  // The file is built in memory, which grows there by copying, and copied once more before it is written.
  const double fields = 4 * (of_last + before) + 3 * rows_of_E;
  const double n_cases = r + nc + h + q;  // whose fields are condensed to the rims before contact is looked for there
  const double contact = r > 0 ? r * n_cases + std::max(2 * n_p(p.size() - 1) * n_cases, 5 * square(r + 2 * nc)) : 0;
  constexpr double libraries = 26e6;
  return {(n_rim > 0 ? 2 : 1) * element_matrices(problem, p[p.size() - 1]),
          2 * entry * size.entries + number * (size.factor + size.largest_front), number * fields, number * contact,
          libraries};
}

void require_memory(const std::string& file, int p, const MemoryNeed& need) {
  using program::bytes_text;
  const bool of_contact = need.contact > need.fields;
  program::require_memory(
      fmt::format("{}: at p = {} this", file, p), need.total(),
      fmt::format(" (shapes {}, factor {}, {} {})", bytes_text(need.elements), bytes_text(need.factor),
                  of_contact ? "contact" : "fields and file", bytes_text(std::max(need.fields, need.contact))),
      fmt::format("a lower p{}, or fewer holes",
                  need.fields > std::max(need.factor, need.contact) ? ", --loads-only, which needs no fields" : ""));
}

}  // namespace fastjoint::stage1
