// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <numeric>
#include <vector>

#include "stage3_nonlinear/equations/rigid_joint.hpp"
#include "stage3_nonlinear/interfaces/friction_layout.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Linear part of a joint, condensed on its n shear planes in a directions and on the moments of its rims of contact,
/// for any stack of plates (docs/theory.md, section 7.1). It depends on the plates and fasteners and on
/// Parameters::held only, not on the other Parameters: loads, laws, clearances, gaps and coefficients of friction.
///
/// The r rows are those of the planes, then those of the moments: delta holds the moments too, and F the forces of
/// their springs. The rows S D + R Lambda + T f + B F = P (per disc and rigid external) and delta = B^T D reduce to
///   F + S_ud delta + H Lambda = Q f,
/// with the amplitudes Lambda of friction and the loads f, and every displacement follows from f, delta, Lambda.
/// S_ud is the parallel sum of the plates' matrices, and exists also if a plate floats.
struct CondensedSystem {
  MatrixXd S_ud;                                ///< (r, r) force / length
  MatrixXd Q;                                   ///< (r, l) forces of rigid fasteners per unit of each load column
  std::vector<Index> rim_sizes = {};            ///< numbers of moments of the rims of contact, rim after rim
  VectorXd Q_scale = VectorXd::Ones(Q.cols());  ///< (l) largest force of each load column, for rounding
  MatrixXd H = MatrixXd(S_ud.rows(), 0);        ///< (r, t) forces by friction, per unit of each amplitude
  std::vector<LoadColumn> load_columns = {};    ///< (l)
  Held held = {};
  FrictionLayout friction = {};  ///< (t)
  /// (N, l) displacements of the joint's N unknowns, given ones included, per unit of each load column at delta = 0.
  MatrixXd D_load = {};
  RigidJoint rigid = {};
  MatrixXd half = {};  ///< (z, r) L^-1 Z^T S Y of `rigid`
  /// Reference stiffness k of each plane, then of each rim of contact, force / length: slightly above the sum of the
  /// absolute values in its rows of S_ud, so that W = K - S_ud is positive definite (docs/theory.md, section 8.2). If
  /// S_ud of a plane is only rounding, k is the plate's own stiffness.
  VectorXd stiffness = {};
  VectorXd K = {};                     ///< (r) the same of each row
  std::vector<Index> long_waves = {};  ///< of each rim of contact, those that TangentFactor does not eliminate alone

  /// r - n a
  [[nodiscard]] Index n_moments() const { return std::accumulate(rim_sizes.begin(), rim_sizes.end(), Index{0}); }
  /// Displacements of all unknowns by relative displacements alone, D_delta delta, (N, columns).
  [[nodiscard]] MatrixXd displaced(const MatrixXd& delta) const;
  /// S_ud x, (r, columns).
  [[nodiscard]] MatrixXd S_times(const MatrixXd& x) const;
  /// W^-1 f, (r), by conjugate gradients: the eigenvalues of K^-1 W are between 1/20 and 1.
  [[nodiscard]] VectorXd metric_times(const VectorXd& f) const;
};

/// Forces q with rounding errors of a load that does not reach a fastener set to zero, since forces are solved relative
/// to the largest.
[[nodiscard]] VectorXd without_rounding(const VectorXd& q, double largest_load);

/// Sets stiffness, K and long_waves.
/// @param own Stiffness of the plates at each plane, (n).
void set_reference(CondensedSystem& system, const VectorXd& own);

/// Condenses a joint. @throws NumericalError naming the plates that can move freely.
[[nodiscard]] CondensedSystem condense(const JointModel& joint, const Held& held);

}  // namespace fastjoint::stage3
