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
/// @param name One of solver_names().
[[nodiscard]] SolveFunction solver_named(const std::string& name);

}  // namespace fastjoint::stage3
