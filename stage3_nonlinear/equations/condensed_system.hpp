// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/rigid_joint.hpp"
#include "stage3_nonlinear/interfaces/friction_layout.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Linear part of a joint, condensed on its n shear planes in a directions and on the moments of its rims of contact,
/// for any stack of plates (docs/theory.md, section 7.1). It is made once from plates and fasteners, and knows no
/// number of a run: loads, laws, clearances, gaps and coefficients of friction are Parameters.
///
/// The r rows are those of the planes, then those of the moments: below, delta holds the moments too, and F the forces
/// of their springs. The rows S D + R Lambda + T f + B F = P (per disc and rigid external) and delta = B^T D leave
///   F + S_ud delta + H Lambda = Q f,
/// with the amounts Lambda of friction and f of loads, and every displacement follows from f, delta, Lambda.
/// S_ud is the parallel sum of the plates' matrices, and exists also when a plate floats.
struct CondensedSystem {
  MatrixXd S_ud;                                ///< (r, r) force / length
  MatrixXd Q;                                   ///< (r, l) forces of rigid fasteners per unit of each load case
  Index n_moments = 0;                          ///< r - n a
  VectorXd Q_scale = VectorXd::Ones(Q.cols());  ///< (l) largest force of each on anything, for rounding
  MatrixXd H = MatrixXd(S_ud.rows(), 0);        ///< (r, t) of friction, per unit of each amount
  std::vector<LoadCase> cases = {};             ///< (l)
  FrictionLayout friction = {};                 ///< (t)
  // Displacements of the joint's N unknowns, given ones included.
  MatrixXd D_load = {};   ///< (N, l) per unit of each load case at delta = 0
  MatrixXd D_delta = {};  ///< (N, r) per relative displacement, dimensionless
  RigidJoint rigid = {};
  /// Reference stiffness k of each plane, then of each rim of contact, force / length, a little more than the sum of
  /// the amounts in its rows of S_ud, so that W = K - S_ud is positive definite (docs/theory.md, section 8.2). Where
  /// S_ud of a plane is nothing but rounding, the plate's own stiffness takes its place.
  VectorXd stiffness = {};
  MatrixXd metric = {};  ///< (r, r) inverse of W, length / force

  [[nodiscard]] Index n_friction() const { return H.cols(); }
};

/// Forces q with zero instead of the rounding of a load that does not reach a fastener: forces are sought relative to
/// the largest.
[[nodiscard]] VectorXd without_rounding(const VectorXd& q, double largest_load);

/// Sets stiffness and metric.
/// @param own Stiffness of the plates themselves at each plane, (n). @param rims Numbers of rows of the rims.
void set_reference(CondensedSystem& system, const VectorXd& own, const std::vector<Index>& rims = {});

/// @throws NumericalError naming the plates that can move if nothing holds them.
[[nodiscard]] CondensedSystem condense(const JointModel& joint);

}  // namespace fastjoint::stage3
