// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {
namespace {

/// The iterate moved by `length` times a step.
Root moved(const RootProblem& problem, Root root, const VectorXd& step, double length) {
  root.x += length * step;
  root.residual = problem.residual(root.x);
  return root;
}

/// Halves the step until the norm of the residual falls; none if it does not.
std::optional<Root> move_by_norm(const RootProblem& problem, const VectorXd& step, const Root& root) {
  constexpr int max_halvings = 40;
  constexpr double min_decrease = 1e-4;  // Armijo's fraction of the decrease by the tangent
  const double norm = root.residual.norm();
  double length = 1;
  for (int i = 0; i < max_halvings; ++i, length /= 2) {
    Root there = moved(problem, root, step, length);
    if (there.residual.norm() <= (1 - min_decrease * length) * norm) return there;
  }
  return std::nullopt;
}

/// Bracket of the step length at which a convex function has its minimum, by its slopes.
class Bracket {
 public:
  explicit Bracket(double before) : low_{0, before} {}

  /// Tells whether the function is certainly lower here than at 0: slopes only rise, so that it has fallen by at least
  /// -slope * length up to `low` and risen by at most slope (length - low) since.
  [[nodiscard]] bool falls_to(double length, double slope) const {
    return slope <= 0 || slope * (length - low_.length) <= -0.5 * low_.slope * low_.length;
  }

  /// Adds a slope and returns the length to try next: extrapolated along the secant until the slope has changed its
  /// sign; then, in rotation, by the secant through both ends, by that through the last two lengths on the same side
  /// (exact if that side is one linear piece), and as the mean of the lengths or of their logarithms.
  double next(double length, double slope) {
    const bool past_minimum = slope >= 0;
    const Sample here{length, slope};
    Sample& end = past_minimum ? high_ : low_;
    const Sample before = std::exchange(end, here);
    constexpr double max_growth = 9;  // times the last increase, also if the slope has not risen at all
    if (!(high_.length > 0))
      return length +
             (length - before.length) *
                 (slope > before.slope ? std::clamp(slope / (before.slope - slope), 1.0, max_growth) : max_growth);
    const bool again = past_minimum == was_past_minimum_ && before.length > 0;
    was_past_minimum_ = past_minimum;
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
  bool was_past_minimum_ = false;
  int repeated_ = 0;
};

/// Moves along the step to a length at which the convex function is certainly lower, and either its slope has risen
/// from `before` < 0 to nearly zero, as far as rounding allows, or the norm of the residual has halved. None if there
/// is no such length.
/// @param dual Metric times the step: its product with a residual is the slope there. @param whole The whole step.
/// @param unbounded Set if the convex function still falls half as steeply at a very large length: it then has no
/// minimum, and there is no root.
std::optional<Root> move_downhill(const RootProblem& problem, const VectorXd& step, const VectorXd& dual,
                                  const Root& whole, const Root& root, bool& unbounded) {
  constexpr int max_tries = 100;
  constexpr double max_slope = 0.03;  // of the slope before
  constexpr double max_norm = 0.5;    // of the norm before
  constexpr double max_length = 1e8;  // of the step
  const double norm_here = root.residual.norm(), before = root.residual.dot(dual);
  Bracket bracket(before);
  std::optional<Root> best;
  double best_slope = -before;
  double length = 1;
  for (int i = 0; i < max_tries && best_slope > -max_slope * before; ++i) {
    Root there = i == 0 ? whole : moved(problem, root, step, length);
    const double norm = there.residual.norm();
    const double slope = there.residual.dot(dual);
    if (norm <= max_norm * norm_here && bracket.falls_to(length, slope)) return there;
    unbounded = length > max_length && slope < 0.5 * before;
    if (unbounded) return std::nullopt;
    if (std::abs(slope) < best_slope && bracket.falls_to(length, slope)) {
      best = std::move(there);
      best_slope = std::abs(slope);
    }
    length = bracket.next(length, slope);
  }
  return best;
}

/// Accepts a whole step that halves the smallest norm so far (docs/theory.md, section 8.4, shows that this may be mixed
/// with steps downhill), and else moves downhill if there is a convex function.
std::optional<Root> move(const RootProblem& problem, const VectorXd& step, double min_norm, const Root& root,
                         bool& unbounded) {
  if (!problem.metric) return move_by_norm(problem, step, root);
  constexpr double max_norm = 0.5;
  Root whole = moved(problem, root, step, 1);
  if (whole.residual.norm() <= max_norm * min_norm) return whole;
  const VectorXd dual = problem.metric(step);
  std::optional<Root> there;
  if (root.residual.dot(dual) < 0) there = move_downhill(problem, step, dual, whole, root, unbounded);
  return there || unbounded ? there : move_by_norm(problem, step, root);
}

/// Residuals of two steps that fall by the same ratio as Newton's method leaves of a force that grows with the depth of
/// contact to the power of 1.5 and vanishes at the root: (1/3)^1.5 = 0.19. It is that of a rim that only just touches.
bool leaves_contact(double norm, double before, double before_that) {
  constexpr double low = 0.16, high = 0.23;
  const auto is_such = [&](double ratio) { return ratio > low && ratio < high; };
  return is_such(norm / before) && is_such(before / before_that);
}

VectorXd newton_step(const RootProblem& problem, const Root& root) {
  if (problem.solve) return -problem.solve(root.x, root.residual);
  return -problem.jacobian(root.x).partialPivLu().solve(root.residual);
}

}  // namespace

const char* text_of(Ending ending) {
  constexpr std::array texts{"converged", "the limit of iterations is reached", "no step lowers the residual",
                             "no solution: the displacements grow without limit", "a value is not finite"};
  return texts[std::size_t(ending)];  // in the order of Ending
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
  double min_norm = std::numeric_limits<double>::infinity();
  // An iteration goes on in a circle if the norm of the residual has stayed the same for many iterations, which steps
  // across corners do not do for long.
  constexpr double same = 1e-3;
  constexpr int many = 25;
  double norm = 0, norm_before = 0;
  int n_same = 0;
  while (!(root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance) && root.iterations < options.max_iterations) {
    ++root.iterations;
    min_norm = std::min(min_norm, root.residual.norm());
    const VectorXd step = newton_step(problem, root);
    bool unbounded = false;
    auto there = step.allFinite() ? move(problem, step, min_norm, root, unbounded) : std::nullopt;
    if (!there) {
      root.ending = !step.allFinite() ? Ending::not_finite : unbounded ? Ending::unbounded : Ending::no_progress;
      break;
    }
    if (leaves_contact(there->residual.norm(), norm, norm_before)) {
      constexpr double length = 1.5;  // the power: a step of this length ends at the root
      Root further = moved(problem, root, step, length);
      if (further.residual.norm() < there->residual.norm()) there = std::move(further);
    }
    root = *std::move(there);
    report();
    norm_before = std::exchange(norm, root.residual.norm());
    n_same = std::abs(norm - norm_before) <= same * norm_before ? n_same + 1 : 0;
    if (n_same >= many) {
      root.ending = Ending::no_progress;
      break;
    }
  }
  root.converged = root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance;
  if (root.converged) root.ending = Ending::converged;
  return root;
}

}  // namespace fastjoint::stage3
