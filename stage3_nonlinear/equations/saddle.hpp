// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace fastjoint::stage3 {

/// LU of the saddle-point matrix [[S, B], [B^T, 0]], scaled row and column so that units and the stiffness of
/// one plate against the next do not matter.
class Saddle {
 public:
  /// @param S Symmetric, positive semi-definite, shape (N, N), force / length.
  /// @param own Stiffness of each unknown's plate, shape (N), force / length; 0 of a plate without any.
  /// @param B Shape (N, n a): of each shear plane and direction, +1 at the first disc, -1 at the second.
  Saddle(const Eigen::MatrixXd& S, const Eigen::VectorXd& own, const Eigen::MatrixXd& B);

  /// False if some motion meets no stiffness while B^T holds.
  [[nodiscard]] bool is_regular() const;
  /// @param rhs Shape (N + n a, columns): forces (force), then relative displacements (length).
  /// @return    Same shape: displacements (length), then forces (force).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;
  /// Motions D that meet no stiffness, one per column, shape (N, count), largest entry 1.
  [[nodiscard]] Eigen::MatrixXd free_motions() const;

 private:
  Eigen::VectorXd scale_;  ///< (N + n a)
  Eigen::MatrixXd matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::Index n_displacements_;
};

}  // namespace fastjoint::stage3
