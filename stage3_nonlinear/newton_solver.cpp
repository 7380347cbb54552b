// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/newton_solver.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;

/// A point on the way along a step.
struct Point {
  VectorXd x, residual;
};

Point point_at(const RootProblem& problem, const Root& root, const VectorXd& step, double length) {
  Point point{root.x + length * step, {}};
  point.residual = problem.residual(point.x);
  return point;
}

bool take(Root& root, Point&& point) {
  root.x = std::move(point.x);
  root.residual = std::move(point.residual);
  return true;
}

/// Moves as far as the residual's norm falls; false if it falls nowhere.
bool move_by_norm(const RootProblem& problem, const VectorXd& step, Root& root) {
  constexpr int most_halvings = 40;
  constexpr double least_fall = 1e-4;  // Armijo's share of what the tangent promises
  const double norm = root.residual.norm();
  double length = 1;
  for (int i = 0; i < most_halvings; ++i, length /= 2) {
    Point point = point_at(problem, root, step, length);
    if (point.residual.norm() <= (1 - least_fall * length) * norm) return take(root, std::move(point));
  }
  return false;
}

/// Moves to where the slope of the convex function along the step has risen from `before` < 0 to little: by false
/// position with halved weights (the Illinois rule) between a point before its least value and one behind.
bool move_downhill(const RootProblem& problem, const VectorXd& step, double before, Root& root) {
  constexpr int most_tries = 60;
  constexpr double little = 0.5;
  const double norm = root.residual.norm();
  double low = 0, low_slope = before, high = 1, high_slope = 0;
  double length = 1;
  for (int i = 0; i < most_tries; ++i) {
    Point point = point_at(problem, root, step, length);
    const double slope = problem.descent(point.residual).dot(step);
    const bool newton = i == 0 && point.residual.norm() <= little * norm;
    if (newton || (i == 0 && slope <= 0) || std::abs(slope) <= little * std::abs(before))
      return take(root, std::move(point));
    const bool behind = !(slope < 0);
    if (behind) {
      if (high_slope > 0) low_slope /= 2;
      high = length;
      high_slope = slope;
    } else {
      high_slope /= 2;
      low = length;
      low_slope = slope;
    }
    length = low - low_slope * (high - low) / (high_slope - low_slope);
    if (!(length > low && length < high)) length = 0.5 * (low + high);
  }
  return false;
}

bool move(const RootProblem& problem, const VectorXd& step, Root& root) {
  if (problem.descent) {
    const double slope = problem.descent(root.residual).dot(step);
    if (slope < 0 && move_downhill(problem, step, slope, root)) return true;
  }
  return move_by_norm(problem, step, root);
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
