// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// A joint with rigid fasteners as the Cholesky factor of its stiffness, scaled so that the factor does not depend on
/// units and on ratios of stiffness between unknowns.
///
/// The displacements of all N unknowns are Z z + Y delta + prescribed ones. For each fastener, z holds the displacement
/// of its disc in the stiffest plate, and the other discs differ from it by the delta of the planes between. The discs
/// of a grounded fastener differ from the ground in the same way. The moments of rims are entries of delta.
class RigidJoint {
 public:
  using SparseMatrix = Eigen::SparseMatrix<double>;

  RigidJoint() = default;
  /// @throws NumericalError naming the plates that can move freely.
  RigidJoint(const JointModel& joint, const Held& held);

  [[nodiscard]] const SparseMatrix& Z() const { return Z_; }  ///< (N, z) of 0 and 1
  [[nodiscard]] const SparseMatrix& Y() const { return Y_; }  ///< (N, r) of -1, 0 and 1
  /// L^-1 Z^T f of forces f on all unknowns, (N, columns), where Z^T S Z = L L^T: (z, columns).
  [[nodiscard]] MatrixXd half_solve(const MatrixXd& f) const { return half_of(Z_.transpose() * f); }
  /// The same of Z^T f, (z, columns).
  [[nodiscard]] MatrixXd half_of(const MatrixXd& f) const { return factor_.matrixL().solve(scale_.asDiagonal() * f); }
  /// Displacements Z L^-T half of all unknowns, (N, columns), length.
  [[nodiscard]] MatrixXd restore(const MatrixXd& half) const {
    return Z_ * MatrixXd(scale_.asDiagonal() * factor_.matrixU().solve(half));
  }
  /// Displacements of all unknowns under forces on them, (N, columns), length.
  [[nodiscard]] MatrixXd moved(const MatrixXd& f) const { return restore(half_solve(f)); }

 private:
  SparseMatrix Z_, Y_;
  VectorXd scale_;  ///< (z)
  Eigen::LLT<MatrixXd> factor_;
};

}  // namespace fastjoint::stage3
