// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage3_nonlinear/joint_model.hpp"

namespace fastjoint::stage3 {

/// All that is linear in a joint, condensed on its n fasteners (theory.md section 5), for any stack of
/// plates.
///
/// Of the rows S D + R Lambda + T f + B F = P (per disc and rigid external) and delta = B^T D remains
///   F + S_ud delta + H+ F+ + H- F- = lambda q,   F+ = max(F, 0), F- = max(-F, 0),
/// and every displacement follows from lambda, delta, F+, F-. S_ud is the parallel sum of the plates'
/// matrices, and exists also when a sheet floats. Without friction H+, H- and their displacements have no
/// entries.
struct CondensedSystem {
  Eigen::VectorXd q;        ///< (n) forces of rigid fasteners at load factor 1, force
  Eigen::MatrixXd S_ud;     ///< (n, n) force / length
  Eigen::MatrixXd H_plus;   ///< (n, n) friction of both plates for F > 0, dimensionless
  Eigen::MatrixXd H_minus;  ///< (n, n) for F < 0
  // Displacements of the joint's N unknowns, given ones included.
  Eigen::VectorXd D_load;           ///< (N) at load factor 1 and delta = 0, length
  Eigen::MatrixXd D_delta;          ///< (N, n) per relative displacement, dimensionless
  Eigen::MatrixXd D_plus, D_minus;  ///< (N, n) per unit F+, F-, length / force

  [[nodiscard]] bool has_friction() const { return H_plus.size() > 0; }
  /// F + S_ud delta + H+ F+ + H- F- - lambda q, shape (n), force.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::VectorXd& F, const Eigen::VectorXd& delta,
                                         double load_factor) const;
  /// Displacements of all discs and rigid externals, shape (N), length.
  [[nodiscard]] Eigen::VectorXd displacements(const Eigen::VectorXd& F, const Eigen::VectorXd& delta,
                                              double load_factor) const;
};

/// @throws NumericalError naming the plates that can move if nothing holds them.
[[nodiscard]] CondensedSystem condense(const JointModel& joint);

}  // namespace fastjoint::stage3
