// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// A way for the joint to move that meets no stiffness at a solution.
struct Mechanism {
  std::vector<Index> open;   ///< shear planes that move within their gaps
  std::vector<Index> level;  ///< those that move under a force that does not grow: with any, a limit load
  VectorXd motion;           ///< (N) displacements, largest entry 1
};

/// Findings of the tangent at a solution.
struct TangentCheck {
  /// A motion without stiffness, if there is one. If none of its planes is level, some plate is free within its gaps
  /// and has no place of its own.
  std::optional<Mechanism> mechanism;
  /// Number of ways in which the solution is unstable: eigenvalues of the tangent with a negative real part
  /// (docs/theory.md, section 9.3). There are none without friction or a law that falls.
  Index unstable = 0;
  /// Friction reserve: the factor on all coefficients of friction at which the joint locks, if it is at most 1; else
  /// empty. At this factor I + H E is singular on the sides that bear (docs/theory.md, section 9.4).
  std::optional<double> locking;

  [[nodiscard]] bool at_limit_load() const { return mechanism && !mechanism->level.empty(); }
};

[[nodiscard]] TangentCheck check_tangent(const JointEquations& equations, const ContactState& state);

/// Friction reserve of the sides that bear under the forces F, (n a).
[[nodiscard]] std::optional<double> self_locking(const CondensedSystem& system, const VectorXd& F);

/// Planes that at the contact coordinates c, (n a), carry all that their laws allow, if nothing else holds the joint.
[[nodiscard]] std::vector<Index> level_planes(const JointEquations& equations, const VectorXd& c);

/// Planes whose laws may fall more steeply than the plates hold against: S_ud + diag(least slopes) is not positive
/// definite, so that the solution may be one of several. Empty if the joint has one solution only (friction aside).
[[nodiscard]] std::vector<Index> planes_that_may_snap(const JointEquations& equations);

/// Derivatives of the bearing forces as vectors, one column for each number (docs/theory.md, section 10).
struct Slopes {
  MatrixXd F;                            ///< (n a, columns)
  MatrixXd c;                            ///< (n a, columns) of the contact coordinates
  std::vector<Index> no_column, no_row;  ///< columns and rows of F that have no derivative
};

/// Slopes by the implicit function theorem: dF = F_c dc with J dc = -residual, at a solution.
/// @param residual Rise of the residual of the condensed system at fixed c, force, shape (n a, columns); the identity
///                 unless given, for which slopes of moments and of c may be left out.
[[nodiscard]] Slopes implicit_slopes(const JointEquations& equations, const ContactState& state,
                                     const std::optional<MatrixXd>& residual = std::nullopt);

/// Replaces the forces without load, under which no rim bears yet, by those of a small load, whose sides tell how
/// friction acts.
void bear(const JointEquations& equations, ContactState& state);

/// Slopes of the forces' amounts, (n, columns); infinite where they do not exist.
[[nodiscard]] MatrixXd of_amounts(const Slopes& slopes, const ContactState& state, const VectorXd& c);

}  // namespace fastjoint::stage3
