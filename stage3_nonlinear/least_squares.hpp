// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

namespace fastjoint::stage3 {

/// Where a sum of squares of residuals is least.
struct LeastSquares {
  Eigen::VectorXd x;        ///< (p), the parameters
  Eigen::MatrixXd inverse;  ///< (p, p), of J^T J: times the variance of a residual their covariance
  bool converged;           ///< the residuals are at right angles to their derivatives
};

/// Residuals (n) of parameters (p), and their derivatives (n, p), n >= p >= 1.
struct ResidualProblem {
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> residual;
  std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> jacobian;
};

/// Levenberg and Marquardt's trust region (gsl_multifit_nlinear) for parameters of order 1. What the functions throw
/// comes out of here.
[[nodiscard]] LeastSquares nonlinear_least_squares(const ResidualProblem& problem, const Eigen::VectorXd& start);

/// Solution of J x = y in the sense of least squares (gsl_multifit_wlinear). @param J (n, p) @param y (n)
[[nodiscard]] LeastSquares linear_least_squares(const Eigen::MatrixXd& J, const Eigen::VectorXd& y);

}  // namespace fastjoint::stage3
