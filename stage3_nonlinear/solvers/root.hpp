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
  /// Gradient, as a function of the residual, of a convex function of x that is least at the root, if there is one,
  /// (n) -> (n).
  VectorFunction gradient{};
  /// The jacobian's inverse at x, (n), times a vector, (n), where there is a quicker way to it than by its factor.
  std::function<VectorXd(const VectorXd&, const VectorXd&)> solve{};
};

/// Why a solver ended.
enum class Ending {
  converged,
  most_iterations,
  no_progress,  ///< no step leads on: GSL's method says so, or no shorter step lowers the residual
  unbounded,    ///< the convex function falls on and on: there is no root
  not_finite    ///< a value or a step is not finite
};
/// "converged", "no step leads on", ...
[[nodiscard]] const char* text_of(Ending ending);

/// Place where a solver ended; not to converge is a result, not an error.
struct Root {
  VectorXd x, residual;  ///< (n); the residual is infinite if the functions have no value at the start
  bool converged = false;
  int iterations = 0;
  Ending ending = Ending::most_iterations;
};

struct RootOptions {
  double tolerance;  ///< on the largest |residual|
  int max_iterations;
  std::function<void(const Root&)> report = {};  ///< is told the start and every iterate
};

/// A way to solve n equations from a start, shape (n), n >= 1.
using SolveFunction = Root (*)(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

/// Makes GSL return errors from now on, instead of aborting; first GSL call of the program.
void take_over_gsl_errors();

/// GSL's hybridsj: Powell's hybrid method with scaled variables and derivatives, MINPACK's HYBRJ.
///
/// A step to where a value is not finite ends the search; what the functions throw comes out of here.
[[nodiscard]] Root hybridsj_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

/// Newton's method with damped steps: the guarantee behind the other solvers.
///
/// If problem.gradient is given, a step ends where its convex function has almost stopped falling along the step, and
/// the method converges from every start if that function is bounded below. Joints without friction whose laws never
/// fall have such a function of the contact coordinate. docs/theory.md, section 8.4, derives it, proves convergence and
/// says where rounding limits it. Otherwise steps are halved until the norm of the residual falls; convergence is then
/// not certain.
[[nodiscard]] Root newton_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
