// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "common/program/memory.hpp"

namespace fastjoint::stage1 {

MemoryNeed memory_need(const PlateProblem& problem, const plate::Skeleton& skeleton, const Eigen::VectorXi& p,
                       int n_rim) {
  const auto [elements, factor] = plate::factor_bytes(problem, skeleton, p[p.size() - 1]);
  const double nc = problem.unknowns.n_controlled(), h = count_of(problem.friction_hole);
  const double q = double(problem.T_c.cols()), r = n_rim;
  const double n_p = problem.unknowns.n_free[p[p.size() - 1]];
  const double rows_of_E = count_of(p) * (nc + h) * nc;
  const double fields = 2 * (n_p * (q + 2) + rows_of_E);  // the second as they are turned to the order of the file
  const double n_cases = r + nc + h + q;  // whose fields are condensed to the rims before contact is looked for there
  const double contact = r > 0 ? r * n_cases + std::max(2 * n_p * n_cases, 5 * std::pow(r + 2 * nc, 2)) : 0;
  constexpr double number = sizeof(double), libraries = 20e6;
  return {(n_rim > 0 ? 2 : 1) * elements, factor, number * fields, number * contact, libraries};
}

void require_memory(const std::string& file, int p, const MemoryNeed& need) {
  using program::bytes_text;
  const bool of_contact = need.contact > need.fields;
  program::require_memory(
      fmt::format("{}: at p = {} this", file, p), need.total(),
      fmt::format(" (shapes {}, factor {}, {} {})", bytes_text(need.elements), bytes_text(need.factor),
                  of_contact ? "contact" : "fields and file", bytes_text(std::max(need.fields, need.contact))),
      "a lower p, or fewer holes");
}

}  // namespace fastjoint::stage1
