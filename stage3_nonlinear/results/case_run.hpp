// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {

/// A load case that has been followed.
struct FollowedCase {
  JointEquations equations;
  LoadPath path;
  Increments increments;
  std::optional<std::size_t> missing = std::nullopt;  ///< the case before it, if that was not solved: no path then
};

/// Follows the load cases of a joint, each from no load or from the last state of the case that it comes after. The
/// joint is condensed once for all cases that hold the same externals.
class CaseRun {
 public:
  /// @param scene Its cases and solver are used; outlives this. @param joint Outlives this.
  CaseRun(const JointScene& scene, const JointModel& joint) : scene_(scene), joint_(joint), bending_(joint, scene) {}

  /// Follows a case, and before it those that it comes after, as far as they have not been.
  ///
  /// @param load_factors Of its increments; none: at every event.
  [[nodiscard]] const Bending& bending() const { return bending_; }

  [[nodiscard]] FollowedCase follow(std::size_t at, const std::vector<double>& load_factors, PathOptions options,
                                    const Wanted& wanted);

 private:
  /// Last state of a case: its loads, contact coordinates and histories.
  struct End {
    VectorXd load, c;
    std::vector<History> history;
  };
  /// The end of the case that another comes after; null if it was not solved.
  const End* end_of(std::size_t at, const PathOptions& options, const Wanted& wanted);
  JointEquations equations(std::size_t at, const End* before);

  const JointScene& scene_;
  const JointModel& joint_;
  Bending bending_;
  std::shared_ptr<const CondensedSystem> system_;
  std::vector<std::shared_ptr<const RimProblem>> rims_;
  std::map<std::size_t, std::optional<End>> ends_;  ///< of the cases that others come after
};

}  // namespace fastjoint::stage3
