// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/exact_path.hpp"
#include "stage3_nonlinear/load_path.hpp"
#include "stage3_nonlinear/solver.hpp"

namespace fastjoint::stage3 {

/// Where a walk along the load factors is.
struct Place {
  double load_factor = 0;
  Eigen::VectorXd c;   ///< (n a) contact coordinates, force
  bool exact = false;  ///< on an exact path
};

/// One walk along the load factors: what has converged, and what it took.
class Walk {
 public:
  /// @param scale What residuals are relative to, force.
  /// @param exact Paths to go by as far as they reach; where one ends, the solvers go on.
  Walk(const JointEquations& equations, const PathOptions& options, double scale, std::vector<ExactPath> exact = {});

  /// Goes to a load factor, in half steps if it must; false if that failed too.
  bool reach(double target);
  [[nodiscard]] const Place& here() const { return here_; }
  /// Goes on from a solution found elsewhere by so many iterations.
  void put(Place place, int iterations);

  [[nodiscard]] PathStep step() const;
  [[nodiscard]] PathFailure failure(std::size_t increment, double load_factor) const;

 private:
  /// On the sides that bear at the last load factor, or would with rigid fasteners without friction: the lower level.
  [[nodiscard]] std::optional<double> locking(double load_factor) const;
  bool advance(double target, int halvings_left);
  bool solve(double target);
  bool take_exact(double target);
  bool solve_by_turns(double target, const RootProblem& problem);
  Root run(const RootProblem& problem, const Eigen::VectorXd& start, SolveFunction solver);
  bool take(const Root& root, double target);
  void note_failure(const Eigen::VectorXd& residual);

  const JointEquations& equations_;
  const PathOptions& options_;
  SolveFunction solver_;
  double scale_;
  std::vector<ExactPath> exact_;
  Place here_;
  int iterations_ = 0;
  double worst_residual_ = 0;
  Eigen::Index worst_row_ = 0;
};

/// Largest |q| at the largest load factor; 1 if nothing reaches the fasteners.
[[nodiscard]] double force_scale(const CondensedSystem& system, const std::vector<double>& load_factors);

}  // namespace fastjoint::stage3
