// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::linalg {

/// A dense symmetric positive definite system [A B^T; B C] whose first n unknowns, the interior ones, are eliminated
/// (static condensation): A = L L^T, X = B L^-T. The boundary unknowns keep the Schur complement C - X X^T.
class Condensed {
 public:
  Condensed() = default;
  /// @param M Shape (n + m, n + m); only its lower triangle is read. Throws NumericalError if A is not positive
  /// definite.
  Condensed(Eigen::MatrixXd M, Eigen::Index n_interior);

  [[nodiscard]] Eigen::Index n_interior() const { return n_; }
  [[nodiscard]] Eigen::Index n_boundary() const { return M_.rows() - n_; }
  /// Schur complement C - X X^T, shape (m, m); only its lower triangle is set.
  [[nodiscard]] auto schur_complement() const { return M_.bottomRightCorner(n_boundary(), n_boundary()); }

  /// X, shape (m, n).
  [[nodiscard]] auto X() const { return M_.bottomLeftCorner(n_boundary(), n_); }

  /// Replaces the loads b on interior unknowns, shape (n, k), by y = L^-1 b, and subtracts X y from those on boundary
  /// unknowns, shape (m, k).
  void eliminate(Eigen::MatrixXd& interior, Eigen::MatrixXd& boundary) const;
  /// Replaces y by the interior solution L^-T (y - X^T u); u is the boundary solution.
  void restore(Eigen::MatrixXd& interior, const Eigen::MatrixXd& boundary) const;

 private:
  [[nodiscard]] auto L() const { return M_.topLeftCorner(n_, n_).triangularView<Eigen::Lower>(); }

  Eigen::Index n_ = 0;
  Eigen::MatrixXd M_;  ///< lower triangle: [L; X S] with the Schur complement S
};

}  // namespace fastjoint::linalg
