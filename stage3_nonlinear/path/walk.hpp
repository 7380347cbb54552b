// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/limit_load.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// State on a walk along the load factors.
struct Place {
  double load_factor = 0;
  VectorXd c;  ///< (r) contact coordinates, force
};

/// Walk along the load factors: the last solution, the iterations, and the reasons of failures.
class Walk {
 public:
  Walk(const JointEquations& equations, const PathOptions& options);

  /// Goes to a load factor as `follow` in load_path.hpp describes; false if that fails.
  bool reach(double target);
  /// Solves at the load factor of a state of the joint with other parameters, starting at its contact coordinates, in
  /// one step; false if that fails.
  bool jump(const Place& from);
  /// Solves the state at no load of a joint with interference, LoadPath::assembled, then that at load factor 0 of a
  /// joint that remembers and has loads there, of a case before or by its sheets' free shapes, and keeps what it has
  /// yielded and slipped; false if the latter fails, which ends the path.
  bool start(LoadPath& path);
  [[nodiscard]] const Place& here() const { return here_; }
  /// Continues from a solution found elsewhere.
  /// @param other Another one, if there is one near.
  void put(Place place, int iterations, std::optional<Place> other = {}) {
    here_ = std::move(place), iterations_ = iterations, other_ = std::move(other);
  }

  [[nodiscard]] PathStep step() const { return step(SolvedPoint(equations_, here_.load_factor, here_.c)); }
  /// The same without a check of the tangent, which takes a factorisation.
  [[nodiscard]] PathStep unchecked_step() const { return step(here_, contact_state(equations_, here_.c), {}); }
  [[nodiscard]] const JointEquations& equations() const { return equations_; }
  /// Appends the state to a path as its next increment and updates the histories; false if PathOptions::each ends the
  /// path.
  bool record(LoadPath& path, std::vector<ContactEvent> events);
  [[nodiscard]] PathFailure failure(Index increment, double load_factor);

  /// The first load factor off the path from no load, if there is one.
  [[nodiscard]] const std::optional<PathLeft>& left() const { return left_; }

 private:
  [[nodiscard]] PathStep step(const SolvedPoint& point) const {
    return step({point.load_factor(), point.c()}, point.state(), point.check());
  }
  [[nodiscard]] PathStep step(const Place& at, const ContactState& state, const TangentCheck& check) const;
  /// The smaller friction reserve: that of the sides that bear at the last load factor, or of those that would bear
  /// with rigid fasteners without friction.
  [[nodiscard]] std::optional<double> locking(double load_factor) const;
  bool follow(double target, int halvings_left);
  bool guess(double target, int halvings_left);
  /// Makes contact coordinates that a try starts at, (r), force; none if it has none.
  using Start = std::function<std::optional<VectorXd>()>;
  bool solve_from_here(double target);
  /// Sets the scale of a try; true if the target is no load, whose solution is known.
  bool begin(double target);
  bool solve_from_guesses(double target);
  bool solve_from(const std::vector<Start>& starts, double target);
  /// The last solution, or that on the straight line through it and the one before if this leaves less residual.
  [[nodiscard]] VectorXd predicted(double target) const;
  /// Solution without friction of a joint whose rims all have gaps, which is a good start for that with friction.
  std::optional<VectorXd> frictionless_start(const Start& from, double target);
  bool solve_with_lagged_friction(double target);
  Root run(const RootProblem& problem, const VectorXd& start, SolveFunction solver);
  /// Adds one step of Newton's method if it lowers the residual: quasi-Newton updates leave more than rounding even for
  /// a piecewise linear joint.
  static void end_by_newton(const RootProblem& problem, Root& root);
  /// True if the residual is not small beside the forces of the fasteners, which may be far below those of rigid ones.
  [[nodiscard]] bool is_far_from_balance(const Root& root) const;
  /// Writes one line to PathOptions::log, with the changes since the iterate before, and replaces that one.
  void log_iteration(const Root& root, std::optional<Root>& before) const;
  /// True if the residual, force, is within the tolerance or within rounding.
  [[nodiscard]] bool converged(const Root& root) const {
    return root.converged ||
           scale_ * root.residual.lpNorm<Eigen::Infinity>() <= std::max(options_.solver.tolerance * scale_, rounding_);
  }
  bool take(const Root& root, double target);
  void note_failure(const Root& root);
  /// Upper bound of the load factors of the sign of the target, found at the first call.
  [[nodiscard]] const std::optional<LimitLoad>& limit(double target);
  /// True if the bound proves that no solution exists at a load factor.
  [[nodiscard]] bool is_beyond_limit(double target);
  /// The same if the bound has been found already, else false: a large joint that can be solved does not need it.
  [[nodiscard]] bool is_known_beyond_limit(double target) {
    return limits_[target < 0 ? 0 : 1].has_value() && is_beyond_limit(target);
  }
  /// True if the best try has ended at a limit load.
  [[nodiscard]] bool at_limit() const;

  JointEquations equations_;  ///< with the history of the increments before
  const PathOptions& options_;
  SolveFunction solver_;
  double rounding_ = 0;  ///< residual by rounding of wide gaps, force
  double scale_ = 1;     ///< reference force of the current try
  double target_ = 0;    ///< load factor of the current try
  bool may_snap_;        ///< the solution may be one of several
  Place here_;
  std::optional<Place> other_;  ///< a solution at another load factor, from which the next may be predicted
  int iterations_ = 0;
  std::set<double> guessed_;  ///< load factors that the first guesses of this increment have been tried at
  std::optional<PathLeft> left_;
  double worst_residual_ = 0;                                      ///< of the best try
  Index worst_row_ = 0;                                            ///< of all unknowns
  VectorXd best_;                                                  ///< contact coordinates of the best try
  Ending ending_ = Ending::converged;                              ///< of the last try
  std::array<std::optional<std::optional<LimitLoad>>, 2> limits_;  ///< of negative and positive load factors, if found
};

/// Reference force of residuals: the largest force of rigid fasteners at a load factor, prescribed displacements
/// included, but at least a small fraction of JointEquations::force_of_gaps, since the rounding of gaps does not vanish
/// with the load, and without load the forces of interference; 1 if that is zero.
[[nodiscard]] double force_scale(const JointEquations& equations, double load_factor);

}  // namespace fastjoint::stage3
