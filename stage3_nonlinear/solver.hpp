// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/root.hpp"

namespace fastjoint::stage3 {

/// A way to solve n equations from a start, shape (n), n >= 1.
using SolveFunction = Root (*)(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

/// A solver by its name in JOINT.json.
struct Solver {
  const char* name;
  SolveFunction solve;
};

/// GSL's (gsl_solver.hpp) and "damped newton" (newton_solver.hpp).
[[nodiscard]] const std::vector<Solver>& solvers();
[[nodiscard]] std::vector<std::string> solver_names();
inline constexpr const char* default_solver = "hybridsj";
inline constexpr const char* exact_path_name = "exact path";  // exact_path.hpp
/// All that "method" in JOINT.json may say: the solvers and the exact path.
[[nodiscard]] std::vector<std::string> method_names();
/// The solver that a method, or none (empty), means where no exact path goes.
[[nodiscard]] std::string iterative_method(const std::string& method);
/// Whether a method, or none, takes an exact path where there is one.
[[nodiscard]] bool may_be_exact(const std::string& method);
/// @param name One of solver_names().
[[nodiscard]] SolveFunction solver_named(const std::string& name);

}  // namespace fastjoint::stage3
