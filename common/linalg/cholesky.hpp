// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

namespace fastjoint::linalg {

/// Supernodal Cholesky factor of a sparse symmetric positive definite matrix (CHOLMOD): factorised once,
/// used for many right-hand sides.
class Cholesky {
 public:
  /// @param lower Lower triangle of the matrix, compressed, shape (n, n).
  /// Throws NumericalError if the matrix is not positive definite or is singular to working precision.
  explicit Cholesky(const Eigen::SparseMatrix<double>& lower);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Solution for all columns of B at once, shape of B.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// Estimate of the reciprocal condition number, from the factor's diagonal.
  [[nodiscard]] double rcond() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The first n rows and columns of a compressed lower triangle.
[[nodiscard]] Eigen::SparseMatrix<double> leading_block(const Eigen::SparseMatrix<double>& lower, int n);

/// Threads that the dense kernels of factorisation and solution may use, from now on.
void set_threads(int n_threads);

}  // namespace fastjoint::linalg
