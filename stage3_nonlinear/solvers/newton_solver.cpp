// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {
namespace {

/// The root so far, moved by `length` steps.
Root moved(const RootProblem& problem, Root root, const VectorXd& step, double length) {
  root.x += length * step;
  root.residual = problem.residual(root.x);
  return root;
}

/// Moves as far as the residual's norm falls; none if it falls nowhere.
std::optional<Root> move_by_norm(const RootProblem& problem, const VectorXd& step, const Root& root) {
  constexpr int most_halvings = 40;
  constexpr double least_fall = 1e-4;  // Armijo's share of what the tangent promises
  const double norm = root.residual.norm();
  double length = 1;
  for (int i = 0; i < most_halvings; ++i, length /= 2) {
    Root there = moved(problem, root, step, length);
    if (there.residual.norm() <= (1 - least_fall * length) * norm) return there;
  }
  return std::nullopt;
}

/// Lengths of a step between which a convex function is least, by its slopes there.
class Bracket {
 public:
  explicit Bracket(double before) : low_{0, before} {}

  /// Tells whether the function is surely lower here than at 0: slopes only rise, so that it has fallen by at least
  /// -slope * length up to `low` and risen by at most slope (length - low) since.
  [[nodiscard]] bool falls_to(double length, double slope) const {
    return slope <= 0 || slope * (length - low_.length) <= -0.5 * low_.slope * low_.length;
  }

  /// Takes in a slope; returns the length to try next: out along the secant until the slope has turned, then in turn by
  /// the secant through both ends, through the last two on the side that was hit (exact where that side is one linear
  /// piece), and the mean of the lengths or of their logarithms.
  double next(double length, double slope) {
    const bool behind = slope >= 0;
    const Sample here{length, slope};
    Sample& end = behind ? high_ : low_;
    const Sample before = std::exchange(end, here);
    constexpr double furthest = 9;  // times the last step out, also where the slope has not risen at all
    if (!(high_.length > 0))
      return length + (length - before.length) *
                          (slope > before.slope ? std::clamp(slope / (before.slope - slope), 1.0, furthest) : furthest);
    const bool again = behind == was_behind_ && before.length > 0;
    was_behind_ = behind;
    repeated_ = again ? repeated_ + 1 : 0;
    if (repeated_ % 3 != 2) {
      const double secant = repeated_ % 3 == 0 ? crossing(low_, high_) : crossing(before, here);
      if (secant > low_.length && secant < high_.length) return secant;
    }
    if (low_.length > 0 && high_.length > 4 * low_.length) return std::sqrt(low_.length * high_.length);
    return 0.5 * (low_.length + high_.length);
  }

 private:
  struct Sample {
    double length, slope;
  };
  static double crossing(const Sample& a, const Sample& b) {
    return a.length - a.slope * (b.length - a.length) / (b.slope - a.slope);
  }

  Sample low_, high_{0, 0};  // high at 0: not known yet
  bool was_behind_ = false;
  int repeated_ = 0;
};

/// Moves to where the convex function surely is lower, and either its slope along the step has risen from `before` < 0
/// to little, or as near as rounding lets it, or the residual is well below what it was; a whole step that brings it
/// well below all before is taken as it is (docs/theory.md, section 8.4, shows that they may mix). None if there is no
/// such place.
/// @param unbounded Set where the function falls on and on: a convex function that still falls half as steeply so far
/// out has no least value, and there is no root.
std::optional<Root> move_downhill(const RootProblem& problem, const VectorXd& step, double before, double least_norm,
                                  const Root& root, bool& unbounded) {
  constexpr int most_tries = 100;
  constexpr double little = 0.03;
  constexpr double well = 0.5;
  constexpr double far_out = 1e8;  // of the step
  const double norm_here = root.residual.norm();
  Bracket bracket(before);
  std::optional<Root> best;
  double best_slope = -before;
  double length = 1;
  for (int i = 0; i < most_tries && best_slope > -little * before; ++i) {
    Root there = moved(problem, root, step, length);
    const double norm = there.residual.norm();
    if (i == 0 && norm <= well * least_norm) return there;
    const double slope = problem.gradient(there.residual).dot(step);
    if (norm <= well * norm_here && bracket.falls_to(length, slope)) return there;
    unbounded = length > far_out && slope < 0.5 * before;
    if (unbounded) return std::nullopt;
    if (std::abs(slope) < best_slope && bracket.falls_to(length, slope)) {
      best = std::move(there);
      best_slope = std::abs(slope);
    }
    length = bracket.next(length, slope);
  }
  return best;
}

std::optional<Root> move(const RootProblem& problem, const VectorXd& step, double least_norm, const Root& root,
                         bool& unbounded) {
  const double slope = problem.gradient ? problem.gradient(root.residual).dot(step) : 0;
  auto there = slope < 0 ? move_downhill(problem, step, slope, least_norm, root, unbounded) : std::nullopt;
  return there || unbounded ? there : move_by_norm(problem, step, root);
}

VectorXd newton_step(const RootProblem& problem, const Root& root) {
  if (problem.solve) return -problem.solve(root.x, root.residual);
  return -problem.jacobian(root.x).partialPivLu().solve(root.residual);
}

}  // namespace

const char* text_of(Ending ending) {
  switch (ending) {
    case Ending::converged:
      return "converged";
    case Ending::no_progress:
      return "no step leads on";
    case Ending::unbounded:
      return "no solution: the joint gives way on and on";
    case Ending::not_finite:
      return "a value is not finite";
    case Ending::most_iterations:
      break;
  }
  return "as many iterations as are allowed";
}

Root newton_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options) {
  Root root{start, problem.residual(start)};
  if (!root.residual.allFinite()) {
    root.residual.setConstant(std::numeric_limits<double>::infinity());
    root.ending = Ending::not_finite;
    return root;
  }
  const auto report = [&] {
    if (options.report) options.report(root);
  };
  report();
  double least_norm = std::numeric_limits<double>::infinity();
  while (!(root.converged = root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance) &&
         root.iterations < options.max_iterations) {
    ++root.iterations;
    least_norm = std::min(least_norm, root.residual.norm());
    const VectorXd step = newton_step(problem, root);
    bool unbounded = false;
    auto there = step.allFinite() ? move(problem, step, least_norm, root, unbounded) : std::nullopt;
    if (!there) {
      root.ending = !step.allFinite() ? Ending::not_finite : unbounded ? Ending::unbounded : Ending::no_progress;
      break;
    }
    root = *std::move(there);
    report();
  }
  if (root.converged) root.ending = Ending::converged;
  return root;
}

}  // namespace fastjoint::stage3
