// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// A hole and direction in which friction acts, there or in another hole of its fastener.
struct FrictionRow {
  Index fastener, hole;  ///< hole of the fastener
  Index direction;       ///< of the joint's directions
};

/// Linear part of a joint, condensed on its n shear planes in a directions and on the moments of its rims of contact,
/// for any stack of plates (docs/theory.md, section 7.1). The r rows are those of the planes, then those of the
/// moments: below, delta holds the moments too, and F the forces of their springs.
///
/// The rows S D + R Lambda + T f + B F = P (per disc and rigid external) and delta = B^T D leave
///   F + S_ud delta + H+ b+ + H- b- = lambda q,   b = E F, b+ = max(b, 0), b- = max(-b, 0),
/// with the laws' forces b on the rims that friction acts on, and every displacement follows from lambda, delta, b.
/// Rims of contact with friction add H_shear tau, with the forces tau of their shears (RimFriction).
/// G also takes the part of a rim's bearing force that differs from b (FrictionLoad::bearing).
/// S_ud is the parallel sum of the plates' matrices, and exists also when a plate floats.
struct CondensedSystem {
  VectorXd q;                         ///< (r) forces of rigid fasteners per unit load factor, force
  MatrixXd S_ud;                      ///< (r, r) force / length
  std::vector<FrictionRow> friction;  ///< (f)
  MatrixXd E;                         ///< (f, r) +1 of a plane that pushes the rim's plate, -1 of one that pulls
  MatrixXd H_plus, H_minus;           ///< (r, f) for b > 0 and b < 0, dimensionless
  MatrixXd H_shear{};                 ///< (r, s) of the shears of rims of contact with friction, dimensionless
  // Displacements of the joint's N unknowns, given ones included.
  VectorXd D_load;           ///< (N) per unit load factor at delta = 0, length
  MatrixXd D_delta;          ///< (N, r) per relative displacement, dimensionless
  MatrixXd D_plus, D_minus;  ///< (N, f) per unit b+, b-, length / force
  MatrixXd D_shear{};        ///< (N, s) per unit of each shear's force, length / force
  // q and D_load where the load factor is negative; empty if they are the same. Loads in holes then bear on the other
  // side.
  VectorXd q_reversed{}, D_load_reversed{};

  [[nodiscard]] bool has_friction() const { return !friction.empty() || H_shear.cols() > 0; }
  /// q at a load factor.
  [[nodiscard]] const VectorXd& q_at(double load_factor) const {
    return load_factor < 0 && q_reversed.size() > 0 ? q_reversed : q;
  }
  /// D_load at a load factor.
  [[nodiscard]] const VectorXd& D_load_at(double load_factor) const {
    return load_factor < 0 && D_load_reversed.size() > 0 ? D_load_reversed : D_load;
  }
  /// F + S_ud delta + H+ b+ + H- b- + H_shear tau - lambda q, shape (r), force.
  /// @param shear tau, (s).
  [[nodiscard]] VectorXd residual(const VectorXd& F, const VectorXd& delta, double load_factor,
                                  const VectorXd& shear = {}) const;
  /// Forces of friction on the planes, H+ b+ + H- b- + H_shear tau, shape (r), force.
  [[nodiscard]] VectorXd friction_forces(const VectorXd& F, const VectorXd& shear = {}) const;
  /// d friction_forces / d F on the sides that bear under F, shape (r, r), dimensionless.
  [[nodiscard]] MatrixXd friction_matrix(const VectorXd& F) const;
  /// Displacements of all discs and rigid externals, shape (N), length.
  [[nodiscard]] VectorXd displacements(const VectorXd& F, const VectorXd& delta, double load_factor,
                                       const VectorXd& shear = {}) const;
};

/// Forces q with zero instead of the rounding of a load that does not reach a fastener: forces are sought relative to
/// the largest.
[[nodiscard]] VectorXd without_rounding(const VectorXd& q, double largest_load);

/// Reciprocal condition number, in the 1-norm and estimated, of a matrix that is of order 1, and so singular also if
/// all of it is small; 0 if a pivot is 0, where Eigen's estimate divides by it and may then drop the infinity that it
/// meets.
[[nodiscard]] double least_stretch(const Eigen::PartialPivLU<MatrixXd>& lu, const MatrixXd& A);

/// Displacements of all unknowns under loads on them while the shear planes do not move and given displacements are 0,
/// (N, loads), length. The joint must be held (condense).
[[nodiscard]] MatrixXd displacements_under(const JointModel& joint, const MatrixXd& loads);

/// @throws NumericalError naming the plates that can move if nothing holds them.
[[nodiscard]] CondensedSystem condense(const JointModel& joint);

}  // namespace fastjoint::stage3
