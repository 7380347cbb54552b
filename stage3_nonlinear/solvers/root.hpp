// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

namespace fastjoint::stage3 {

using VectorFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
using MatrixFunction = std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>;

/// n equations in n unknowns, both of order 1.
struct RootProblem {
  VectorFunction residual;  ///< (n) -> (n)
  MatrixFunction jacobian;  ///< (n) -> (n, n), entry (i, j) = d residual_i / d x_j
  /// Of a residual: the gradient of a convex function of x that is least at the root, if there is one, (n) -> (n).
  VectorFunction descent;
};

struct RootOptions {
  double tolerance;  ///< on the largest |residual|
  int max_iterations;
};

/// Where a solver ended; not to converge is a result, not an error.
struct Root {
  Eigen::VectorXd x, residual;  ///< (n); the residual is infinite if the functions have no value at the start
  bool converged = false;
  int iterations = 0;
};

/// A way to solve n equations from a start, shape (n), n >= 1.
using SolveFunction = Root (*)(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
