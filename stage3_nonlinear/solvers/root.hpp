// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using VectorFunction = std::function<VectorXd(const VectorXd&)>;

/// n equations in n unknowns, both of order 1.
struct RootProblem {
  VectorFunction residual;                            ///< (n) -> (n)
  std::function<MatrixXd(const VectorXd&)> jacobian;  ///< (n) -> (n, n), entry (i, j) = d residual_i / d x_j
  /// Product with a symmetric positive definite matrix that makes the residual the gradient of a convex function with
  /// its minimum at the root, if there is one, (n) -> (n).
  VectorFunction metric{};
  /// The inverse of the Jacobian at x, (n), times a vector, (n), if there is a faster way than by its factor.
  std::function<VectorXd(const VectorXd&, const VectorXd&)> solve{};
};

/// Why a solver ended.
enum class Ending {
  converged,
  max_iterations,
  no_progress,  ///< GSL's method stagnates, or no shorter step lowers the residual
  unbounded,    ///< the convex function has no minimum: there is no root
  not_finite    ///< a value or a step is not finite
};
/// "converged", "no step lowers the residual", ...
[[nodiscard]] const char* text_of(Ending ending);

/// Last iterate of a solver; not to converge is a result, not an error.
struct Root {
  VectorXd x, residual;  ///< (n); the residual is infinite if the functions have no value at the start
  bool converged = false;
  int iterations = 0;
  Ending ending = Ending::max_iterations;
};

struct RootOptions {
  double tolerance;  ///< on the largest |residual|
  int max_iterations;
  std::function<void(const Root&)> report = {};  ///< called with the start and every iterate
};

/// A method that solves n equations from a start, shape (n), n >= 1.
using SolveFunction = Root (*)(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

/// Makes GSL return errors from now on, instead of aborting; first GSL call of the program.
void take_over_gsl_errors();

/// GSL's hybridsj: Powell's hybrid method with scaled variables and derivatives, MINPACK's HYBRJ.
///
/// A step to a value that is not finite ends the search; exceptions of the functions are passed on.
[[nodiscard]] Root hybridsj_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

/// Newton's method with damped steps, used where the other solvers fail.
///
/// If problem.metric is given, a step ends near the minimum of its convex function along the step, and the method
/// converges from every start if that function is bounded below. Joints without friction whose laws never fall have
/// such a function of the contact coordinate. docs/theory.md, section 8.4, derives it, proves convergence and gives the
/// limits by rounding. Otherwise steps are halved until the norm of the residual falls, and convergence is not certain.
[[nodiscard]] Root newton_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
