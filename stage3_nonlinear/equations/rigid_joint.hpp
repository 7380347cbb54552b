// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// A joint whose shear planes do not move, as the Cholesky factor of its stiffness, scaled so that units and the
/// stiffness of one unknown against the next do not matter.
///
/// The displacements of all N unknowns are Z z + Y delta + given ones: those of the stiffest plate's disc of each
/// fastener are in z, the others lie behind it by the delta of the planes between. All discs of a fastener that the
/// ground holds lie behind the ground. The moments of rims are entries of delta themselves.
class RigidJoint {
 public:
  using SparseMatrix = Eigen::SparseMatrix<double>;

  RigidJoint() = default;
  /// @param S (N, N) of all plates. @throws NumericalError naming the plates that can move if nothing holds them.
  RigidJoint(const JointModel& joint, const MatrixXd& S);

  [[nodiscard]] const SparseMatrix& Z() const { return Z_; }  ///< (N, z) of 0 and 1
  [[nodiscard]] const SparseMatrix& Y() const { return Y_; }  ///< (N, r) of -1, 0 and 1
  /// L^-1 Z^T f of forces f on all unknowns, (N, columns), where Z^T S Z = L L^T: (z, columns).
  [[nodiscard]] MatrixXd half_solve(const MatrixXd& f) const;
  /// Displacements Z L^-T of that: of all unknowns under the forces, (N, columns), length.
  [[nodiscard]] MatrixXd restore(const MatrixXd& half) const;
  /// Displacements of all unknowns under forces on them, (N, columns), length.
  [[nodiscard]] MatrixXd moved(const MatrixXd& f) const { return restore(half_solve(f)); }

 private:
  SparseMatrix Z_, Y_;
  VectorXd scale_;  ///< (z)
  Eigen::LLT<MatrixXd> factor_;
};

}  // namespace fastjoint::stage3
