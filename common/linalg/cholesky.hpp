// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace fastjoint::linalg {

/// Supernodal Cholesky factor of a sparse symmetric positive definite matrix (CHOLMOD) in the given order of unknowns;
/// elimination_order finds one with little fill.
class Cholesky {
 public:
  /// @param lower Lower triangle, compressed, rows ascending, every diagonal entry stored.
  /// @param n Size of the leading block that is factorised; rows after it are not read.
  /// Throws NumericalError if the block is not positive definite, or singular to working precision.
  Cholesky(const Eigen::SparseMatrix<double>& lower, Eigen::Index n);
  explicit Cholesky(const Eigen::SparseMatrix<double>& lower) : Cholesky(lower, lower.cols()) {}
  ~Cholesky();

  /// Solves X A = B for k right-hand sides, the rows of B, shape (k, n).
  [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd B) const;
  /// Computes C_k A^-1 C^T, shape (k, m), where C_k is the first k rows of C: energy products of the solutions for rows
  /// of C. Forward elimination of a row visits only the supernodes on its path up the elimination tree (Liu, SIAM
  /// Review 34, 82, 1992).
  /// @param C Shape (m, n), compressed, rows ascending in every column.
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::SparseMatrix<double>& C, Eigen::Index k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Finds an order of elimination with little fill and contiguous supernodes: unknown order[i] is eliminated as i-th.
/// @param graph Lower triangle of a pattern, compressed, shape (n, n), every diagonal entry stored.
[[nodiscard]] std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& graph);

}  // namespace fastjoint::linalg
