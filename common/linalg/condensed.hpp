// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::linalg {

/// A dense symmetric positive definite system [A B^T; B C] of which the first n unknowns, those inside, are eliminated
/// (static condensation): A = L L^T, X = B L^-T, and C - X X^T is left for those outside.
class Condensed {
 public:
  Condensed() = default;
  /// @param M Shape (n + m, n + m), its lower triangle counts. Throws NumericalError if A is not positive definite.
  Condensed(Eigen::MatrixXd M, Eigen::Index n_inside);

  [[nodiscard]] Eigen::Index n_inside() const { return n_; }
  [[nodiscard]] Eigen::Index n_outside() const { return M_.rows() - n_; }
  /// C - X X^T, shape (m, m); its lower triangle counts.
  [[nodiscard]] auto outside() const { return M_.bottomRightCorner(n_outside(), n_outside()); }

  /// Loads inside, shape (n, k), become y = L^-1 b; what they do outside is taken off, shape (m, k).
  void eliminate(Eigen::MatrixXd& inside, Eigen::MatrixXd& outside) const;
  /// y becomes the solution inside, L^-T (y - X^T u), u the solution outside.
  void restore(Eigen::MatrixXd& inside, const Eigen::MatrixXd& outside) const;

 private:
  Eigen::Index n_ = 0;
  Eigen::MatrixXd M_;  ///< lower triangle of [L; X C], as the factor of the first n columns has it
};

/// A B^T by BLAS, for shapes at which that pays.
[[nodiscard]] Eigen::MatrixXd product_transposed(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Condensed stiffness S = E_c E_c^T - diag(shift), shape (nc, nc), force / length: S_ij is the force on i per
/// displacement of j, and the energy product of the unit fields i and j, which makes it superconvergent
/// (docs/theory.md, sections 4.1 and 4.4; Babuska & Miller, Int. J. Numer. Meth. Engng 20, 1085, 1984). S is zero where
/// rounding is all that is left of K_cc, as in a sheet held by one disc alone.
[[nodiscard]] Eigen::MatrixXd condensed_stiffness(const Eigen::MatrixXd& E_c, const Eigen::VectorXd& shift,
                                                  const Eigen::MatrixXd& K_cc);

}  // namespace fastjoint::linalg
