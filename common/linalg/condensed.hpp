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

  /// X, shape (m, n).
  [[nodiscard]] auto eliminated() const { return M_.bottomLeftCorner(n_outside(), n_); }

  /// Loads inside, shape (n, k), become y = L^-1 b; what they do outside is taken off, shape (m, k).
  void eliminate(Eigen::MatrixXd& inside, Eigen::MatrixXd& outside) const;
  /// y becomes the solution inside, L^-T (y - X^T u), u the solution outside.
  void restore(Eigen::MatrixXd& inside, const Eigen::MatrixXd& outside) const;

 private:
  [[nodiscard]] auto L() const { return M_.topLeftCorner(n_, n_).triangularView<Eigen::Lower>(); }

  Eigen::Index n_ = 0;
  Eigen::MatrixXd M_;  ///< lower triangle of [L; X C], as the factor of the first n columns has it
};

}  // namespace fastjoint::linalg
