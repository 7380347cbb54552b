// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Reciprocal condition, with columns scaled, below which a tangent is singular.
inline constexpr double singular_tangent = 1e-10;

/// Gives A columns of largest entry 1 and returns what they were divided by.
Eigen::VectorXd scale_columns(Eigen::MatrixXd& A);

/// A way for the joint to move that meets no stiffness at a solution: open fasteners alone hold some plate, whose
/// place within their gaps is not determined.
struct Mechanism {
  std::vector<Eigen::Index> open;  ///< shear planes
  Eigen::VectorXd motion;          ///< (N) displacements, largest entry 1
};

/// What the tangent at a solution says of it.
struct TangentCheck {
  std::optional<Mechanism> mechanism;
  /// The determinant of the tangent is negative: a load a little larger would need smaller displacements. Never
  /// without friction or a law that falls.
  bool turned = false;
  /// Where it is at most 1: the factor on all friction at which I + H E, theory.md's I - R M of all plates together,
  /// becomes singular on the sides that bear (self-locking).
  std::optional<double> locking;
};

[[nodiscard]] TangentCheck check_tangent(const JointEquations& equations, const ContactState& state);

/// The same factor for the sides that bear under the forces F, (n a).
[[nodiscard]] std::optional<double> self_locking(const CondensedSystem& system, const Eigen::VectorXd& F);

/// Planes whose laws may fall more steeply than the plates hold against: S_ud + diag(least slopes) is not positive
/// definite, so that the solution may be one of several. Empty if the joint has one solution only (friction aside).
[[nodiscard]] std::vector<Eigen::Index> planes_that_may_snap(const JointEquations& equations);

}  // namespace fastjoint::stage3
