// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace fastjoint::linalg {

/// Supernodal Cholesky factor L of a sparse symmetric positive definite matrix (CHOLMOD), in the order in which the
/// matrix comes: elimination_order finds a good one. The last rows and columns may be a border: what is left of it when
/// the rest is eliminated, its Schur complement, stands in L.
class Cholesky {
 public:
  /// @param lower Lower triangle of the matrix, compressed, shape (n, n).
  /// @param n_border Number of its last rows and columns that are the border.
  /// Throws NumericalError if the matrix is not positive definite, and if it, without its border, is singular to
  /// working precision.
  explicit Cholesky(const Eigen::SparseMatrix<double>& lower, Eigen::Index n_border = 0);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Solution with the border held at zero for all columns of B at once, shape of B: (n - n_border, k).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// L within the border, its first k columns, shape (n_border, k): the Schur complement of these rows and columns is
  /// their product with their transpose.
  [[nodiscard]] Eigen::MatrixXd border(Eigen::Index k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Order of elimination that fills a matrix little, with supernodes together: order[i] is eliminated as i-th.
/// @param graph Lower triangle of a pattern, compressed, shape (n, n), every diagonal entry stored.
[[nodiscard]] std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& graph);

}  // namespace fastjoint::linalg
