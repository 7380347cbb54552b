// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/newton_solver.hpp"

#include <Eigen/LU>
#include <limits>

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;

/// Moves `root` along `step` as far as the residual falls; false if it falls nowhere.
bool move(const RootProblem& problem, const VectorXd& step, Root& root) {
  constexpr int most_halvings = 40;
  constexpr double least_fall = 1e-4;  // Armijo's share of what the tangent promises
  const double norm = root.residual.norm();
  double length = 1;
  for (int i = 0; i < most_halvings; ++i, length /= 2) {
    const VectorXd x = root.x + length * step;
    const VectorXd residual = problem.residual(x);
    if (!(residual.norm() <= (1 - least_fall * length) * norm)) continue;
    root.x = x;
    root.residual = residual;
    return true;
  }
  return false;
}

}  // namespace

Root newton_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options) {
  Root root{start, problem.residual(start)};
  if (!root.residual.allFinite()) {
    root.residual.setConstant(std::numeric_limits<double>::infinity());
    return root;
  }
  while (!(root.converged = root.residual.cwiseAbs().maxCoeff() <= options.tolerance) &&
         root.iterations < options.max_iterations) {
    ++root.iterations;
    const VectorXd step = -problem.jacobian(root.x).partialPivLu().solve(root.residual);
    if (!step.allFinite() || !move(problem, step, root)) break;
  }
  return root;
}

}  // namespace fastjoint::stage3
