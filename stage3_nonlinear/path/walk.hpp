// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/limit_load.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// Place of a walk along the load factors.
struct Place {
  double load_factor = 0;
  VectorXd c;  ///< (r) contact coordinates, force
};

/// Walk along the load factors: what has converged, and what it took.
class Walk {
 public:
  Walk(const JointEquations& equations, const PathOptions& options);

  /// Goes to a load factor, as load_path.hpp says; false if nothing led there.
  bool reach(double target);
  /// Goes to the load factor of a state of the joint with other numbers, from its contact coordinates and without steps
  /// between; false if that leads to no solution.
  bool jump(const Place& from);
  /// Goes to no load where discs are larger than their holes; contact coordinates there, (r), if that was solved.
  std::optional<VectorXd> assemble();
  [[nodiscard]] const Place& here() const { return here_; }
  /// Goes on from a solution found elsewhere by so many iterations.
  void put(Place place, int iterations) { here_ = std::move(place), iterations_ = iterations; }

  [[nodiscard]] PathStep step() const { return step(SolvedPoint(equations_, here_.load_factor, here_.c)); }
  [[nodiscard]] const JointEquations& equations() const { return equations_; }
  /// Appends the place to a path as its next increment, which interfaces then remember; false if the taker of
  /// increments ends the path.
  bool record(LoadPath& path, std::vector<ContactEvent> events);
  [[nodiscard]] PathFailure failure(Index increment, double load_factor);

  /// The place where the path from no load was left, if it was.
  [[nodiscard]] const std::optional<PathLeft>& left() const { return left_; }

 private:
  [[nodiscard]] PathStep step(const SolvedPoint& point) const;
  /// Lower friction reserve of the sides that bear at the last load factor and of those that would bear if the
  /// fasteners were rigid and without friction.
  [[nodiscard]] std::optional<double> locking(double load_factor) const;
  /// True if a residual, force, is within the tolerance or within rounding.
  [[nodiscard]] bool is_small(double residual) const;
  bool follow(double target, int halvings_left);
  bool guess(double target, int halvings_left);
  bool solve_from_here(double target);
  /// Sets the scale of a try, and goes to no load, whose solution is known.
  bool begin(double target);
  bool solve_from_guesses(double target);
  bool solve_from(const std::vector<VectorXd>& starts, double target);
  /// Solution without friction of a joint whose rims all have gaps, from where friction takes few steps.
  std::optional<VectorXd> loose_without_friction(const VectorXd& start, double target);
  bool solve_by_turns(double target);
  Root run(const RootProblem& problem, const VectorXd& start, SolveFunction solver);
  /// Takes one step of Newton's method where it lowers the residual: secants leave more than rounding also of a joint
  /// that is linear between corners.
  static void end_by_newton(const RootProblem& problem, Root& root);
  /// One line of PathOptions::log, with what has changed since the iterate before, which becomes this one.
  void log_iteration(const Root& root, std::optional<Root>& before) const;
  [[nodiscard]] bool converged(const Root& root) const {
    return root.converged || is_small(scale_ * root.residual.lpNorm<Eigen::Infinity>());
  }
  bool take(const Root& root, double target);
  void note_failure(const Root& root);
  /// Bound of the load factors of a sign, found when it is first asked for.
  [[nodiscard]] const std::optional<LimitLoad>& limit(double target);
  /// True if no solution exists at a load factor, as the bound proves.
  [[nodiscard]] bool is_too_much(double target);
  /// The same, but false as long as nobody has asked for the bound, so that a large joint that is solved takes no time
  /// for it.
  [[nodiscard]] bool is_known_too_much(double target) {
    return limits_[target < 0 ? 0 : 1].has_value() && is_too_much(target);
  }
  /// True if the best try has ended where laws allow no more force and nothing else holds the joint.
  [[nodiscard]] bool gives_way() const;

  JointEquations equations_;  ///< with the history of the increments before
  const PathOptions& options_;
  SolveFunction solver_;
  double rounding_ = 0;  ///< residual that rounding of wide gaps leaves, force
  double scale_ = 1;     ///< of the load factor that is tried, force
  double target_ = 0;    ///< load factor that is tried
  bool may_snap_;        ///< the solution may be one of several
  Place here_;
  int iterations_ = 0;
  std::optional<PathLeft> left_;
  double worst_residual_ = 0;                                      ///< of the best try
  Index worst_row_ = 0;                                            ///< of all unknowns
  VectorXd best_;                                                  ///< contact coordinates of the best try
  std::array<std::optional<std::optional<LimitLoad>>, 2> limits_;  ///< of negative and positive load factors, if asked
};

/// Force against which residuals count: the largest force of rigid fasteners at a load factor, of given displacements
/// too, but no less than a small part of what gaps of rims would take, whose rounding does not vanish with the load,
/// and without any load no less than that itself; 1 if nothing reaches the fasteners.
[[nodiscard]] double force_scale(const JointEquations& equations, double load_factor);

}  // namespace fastjoint::stage3
