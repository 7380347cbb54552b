// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/solver.hpp"

#include <stdexcept>

#include "stage3_nonlinear/gsl_solver.hpp"
#include "stage3_nonlinear/newton_solver.hpp"

namespace fastjoint::stage3 {

const std::vector<Solver>& solvers() {
  static const std::vector<Solver> all = [] {
    std::vector<Solver> result = gsl_solvers();
    result.push_back({"damped newton", newton_root});
    return result;
  }();
  return all;
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  names.reserve(solvers().size());
  for (const auto& solver : solvers()) names.emplace_back(solver.name);
  return names;
}

SolveFunction solver_named(const std::string& name) {
  for (const auto& solver : solvers())
    if (name == solver.name) return solver.solve;
  throw std::logic_error("solver_named: no solver has this name");
}

}  // namespace fastjoint::stage3
