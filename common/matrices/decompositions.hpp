// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

/// Decompositions of dense matrices by LAPACK, which, unlike Eigen's, take no time to compile.
/// Values are NaN where LAPACK's iteration does not converge, as for a matrix with a NaN.
namespace fastjoint::matrices {

/// True if Cholesky factorisation of a symmetric matrix, (n, n), finds only positive pivots. The lower triangle is
/// read.
[[nodiscard]] bool is_positive_definite(Eigen::MatrixXd A);

/// Inverse of a symmetric positive definite matrix, (n, n), whose lower triangle is read; empty if a pivot is not
/// positive. LAPACK takes half as long for it as Eigen's solution for the identity.
[[nodiscard]] std::optional<Eigen::MatrixXd> inverse_of_positive(Eigen::MatrixXd A);

/// Factors P A = L U of a square matrix, with rows exchanged for the largest pivots.
class Lu {
 public:
  Lu() = default;
  /// @param A (n, n).
  explicit Lu(Eigen::MatrixXd A);

  /// Solution x of A x = b, (n, columns); not finite where a pivot is 0.
  [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd b) const { return solved("N", std::move(b)); }
  /// Solution x of A^T x = b, (n, columns).
  [[nodiscard]] Eigen::MatrixXd solve_transposed(Eigen::MatrixXd b) const { return solved("T", std::move(b)); }
  /// 1-norm of A: largest sum of absolute values of a column.
  [[nodiscard]] double norm() const { return norm_; }
  /// Reciprocal condition number in that norm, estimated; 0 where a pivot is 0.
  [[nodiscard]] double rcond() const;
  /// True if the determinant of A is below 0.
  [[nodiscard]] bool is_negative() const;

 private:
  [[nodiscard]] Eigen::MatrixXd solved(const char* which, Eigen::MatrixXd b) const;

  Eigen::MatrixXd factors_;
  std::vector<int> pivots_;
  double norm_ = 0;
};

/// Orthonormal basis of the columns of a matrix, (m, n) with m >= n: Q, (m, n), of A = Q R.
[[nodiscard]] Eigen::MatrixXd orthonormal_basis(Eigen::MatrixXd A);

/// Eigenvalues of a symmetric matrix, (n, n), whose lower triangle is read: (n), from the smallest on.
[[nodiscard]] Eigen::VectorXd symmetric_eigenvalues(Eigen::MatrixXd A);

/// A = vectors values vectors^T.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< (n) from the smallest on
  Eigen::MatrixXd vectors;  ///< (n, n) orthonormal columns
};
/// Eigenvalues and eigenvectors of a symmetric matrix, (n, n), whose lower triangle is read.
[[nodiscard]] SymmetricEigen symmetric_eigen(Eigen::MatrixXd A);

/// Eigenvalues of a matrix, (n, n): (n), in no order, those of a complex pair one after the other.
[[nodiscard]] Eigen::VectorXcd eigenvalues(Eigen::MatrixXd A);

/// A = U values V^T of a matrix, (m, n), with k = min(m, n).
struct SingularValues {
  Eigen::MatrixXd U;       ///< (m, k) orthonormal columns
  Eigen::VectorXd values;  ///< (k) from the largest on
  Eigen::MatrixXd V;       ///< (n, k) orthonormal columns

  /// Number of singular values above this fraction of the largest.
  [[nodiscard]] Eigen::Index rank(double fraction) const;
  /// Least-squares solution x of min |A x - b| with minimum norm, (n, columns); singular values up to this fraction of
  /// the largest count as zero.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b, double fraction) const;
};
[[nodiscard]] SingularValues singular_values(Eigen::MatrixXd A);

}  // namespace fastjoint::matrices
