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

std::vector<std::string> method_names() {
  auto names = solver_names();
  names.emplace_back(exact_path_name);
  return names;
}

bool may_be_exact(const std::string& method) { return method.empty() || method == exact_path_name; }

std::string iterative_method(const std::string& method) { return may_be_exact(method) ? default_solver : method; }

SolveFunction solver_named(const std::string& name) {
  for (const auto& solver : solvers())
    if (name == solver.name) return solver.solve;
  throw std::logic_error("solver_named: no solver has this name");
}

}  // namespace fastjoint::stage3
