// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/equations/tangent_factor.hpp"

namespace fastjoint::stage3 {

/// A motion of the joint without stiffness at a solution.
struct Mechanism {
  std::vector<Index> open;   ///< shear planes that move within their gaps
  std::vector<Index> level;  ///< shear planes that move under a constant force: with any, a limit load
  VectorXd motion;           ///< (N) displacements, largest entry 1
};

/// Findings of the tangent at a solution.
struct TangentCheck {
  /// A motion without stiffness, if there is one. If none of its planes is level, some plate is free within its gaps,
  /// and its position is indeterminate.
  std::optional<Mechanism> mechanism;
  /// Number of unstable modes of the solution: eigenvalues of the tangent with a negative real part
  /// (docs/theory.md, section 9.3). There are none without friction or a law that falls. Of 400 unknowns and more in
  /// contact with friction, 1 if their number is odd.
  Index unstable = 0;
  /// Friction reserve: the factor on all coefficients of friction at which the joint is self-locking, if it is at most
  /// 1; else empty. At this factor I + H E is singular for the bearing sides (docs/theory.md, section 9.4).
  std::optional<double> locking;

  [[nodiscard]] bool at_limit_load() const { return mechanism && !mechanism->level.empty(); }
};

/// @param factor Of the tangent at the state.
[[nodiscard]] TangentCheck check_tangent(const JointEquations& equations, const ContactState& state,
                                         const TangentFactor& factor);

/// Friction reserve for the sides that bear under the forces F, (r).
[[nodiscard]] std::optional<double> self_locking(const JointEquations& equations, const VectorXd& F);

/// Planes at the maximum force of their laws at the contact coordinates c, (r), if the joint is then a mechanism.
[[nodiscard]] std::vector<Index> level_planes(const JointEquations& equations, const VectorXd& c);

/// Planes whose laws may fall more steeply than the stiffness of the plates: S_ud + diag(min slopes) is not positive
/// definite, so that the solution may be one of several. Empty if the joint without friction has one solution only.
[[nodiscard]] std::vector<Index> planes_that_may_snap(const JointEquations& equations);

}  // namespace fastjoint::stage3
