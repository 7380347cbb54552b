// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace fastjoint::linalg {

/// Supernodal Cholesky factor of a sparse symmetric positive definite matrix (CHOLMOD), in the order in which the
/// matrix comes: elimination_order finds a good one.
class Cholesky {
 public:
  /// @param lower Lower triangle, compressed, rows ascending, every diagonal entry stored.
  /// @param n Size of the leading block of it that is factorised, in place; none of the rows behind it is read.
  /// Throws NumericalError if the block is not positive definite, or singular to working precision.
  Cholesky(const Eigen::SparseMatrix<double>& lower, Eigen::Index n);
  explicit Cholesky(const Eigen::SparseMatrix<double>& lower) : Cholesky(lower, lower.cols()) {}
  ~Cholesky();

  /// Solutions X of X A = B, shape (k, n): of the right-hand sides in the rows of B, in which they lie together.
  [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd B) const;
  /// C_k A^-1 C^T, shape (k, m), where C_k is the first k rows of C: the products in energy of the solutions for rows
  /// of C. A row is taken no further than where elimination carries it (Liu, SIAM Review 34, 82, 1992).
  /// @param C Shape (m, n), compressed, rows ascending in every column.
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::SparseMatrix<double>& C, Eigen::Index k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Order of elimination that fills a matrix little, with supernodes together: order[i] is eliminated as i-th.
/// @param graph Lower triangle of a pattern, compressed, shape (n, n), every diagonal entry stored.
[[nodiscard]] std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& graph);

}  // namespace fastjoint::linalg
