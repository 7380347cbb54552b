// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/matrices/decompositions.hpp"

#include <algorithm>
#include <complex>
#include <limits>
#include <vector>

// The header would take C's complex numbers, and with them a macro named I.
#define lapack_complex_float std::complex<float>
#define lapack_complex_double std::complex<double>
#include <lapacke.h>

namespace fastjoint::matrices {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

lapack_int size_of(Index n) { return static_cast<lapack_int>(n); }
/// Leading dimension, which LAPACK requires to be at least 1.
lapack_int stride_of(const MatrixXd& A) { return std::max<lapack_int>(size_of(A.rows()), 1); }

/// LAPACK's info after a routine that is asked for the length of its workspace first.
template <typename Routine>
lapack_int with_workspace(const Routine& routine) {
  constexpr lapack_int ask = -1;
  double length = 1;
  lapack_int info = routine(&length, ask);
  if (info != 0) return info;
  std::vector<double> work(static_cast<std::size_t>(length));
  return routine(work.data(), size_of(std::ssize(work)));
}

/// Eigenvalues of a symmetric matrix, in which its eigenvectors replace it if `job` is V.
VectorXd symmetric(const char* job, MatrixXd& A) {
  const lapack_int n = size_of(A.rows()), stride = stride_of(A);
  VectorXd values(n);
  // Job V needs the longest integer workspace.
  std::vector<lapack_int> integers(3 + 5 * static_cast<std::size_t>(n));
  const lapack_int n_integers = size_of(std::ssize(integers));
  const lapack_int info = with_workspace([&](double* work, lapack_int length) {
    lapack_int result = 0;
    LAPACK_dsyevd(job, "L", &n, A.data(), &stride, values.data(), work, &length, integers.data(), &n_integers, &result);
    return result;
  });
  if (info != 0) values.setConstant(nan);
  return values;
}

/// Cholesky's factor L in the lower triangle; LAPACK's info.
lapack_int factorise(MatrixXd& A) {
  const lapack_int n = size_of(A.rows()), stride = stride_of(A);
  lapack_int info = 0;
  LAPACK_dpotrf("L", &n, A.data(), &stride, &info);
  return info;
}

}  // namespace

bool is_positive_definite(MatrixXd A) { return factorise(A) == 0; }

std::optional<MatrixXd> inverse_of_positive(MatrixXd A) {
  const lapack_int n = size_of(A.rows()), stride = stride_of(A);
  lapack_int info = factorise(A);
  if (info == 0) LAPACK_dpotri("L", &n, A.data(), &stride, &info);
  if (info != 0) return std::nullopt;
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  return A;
}

Lu::Lu(MatrixXd A) : factors_(std::move(A)), pivots_(static_cast<std::size_t>(factors_.rows())) {
  if (factors_.size() == 0) return;
  norm_ = factors_.cwiseAbs().colwise().sum().maxCoeff();
  const lapack_int n = size_of(factors_.rows());
  lapack_int info = 0;  // a pivot of 0 shows in the factor
  LAPACK_dgetrf(&n, &n, factors_.data(), &n, pivots_.data(), &info);
}

MatrixXd Lu::solved(const char* which, MatrixXd b) const {
  if (b.size() == 0) return b;
  const lapack_int n = size_of(factors_.rows()), columns = size_of(b.cols());
  lapack_int info = 0;
  LAPACK_dgetrs(which, &n, &columns, factors_.data(), &n, pivots_.data(), b.data(), &n, &info);
  return b;
}

double Lu::rcond() const {
  if (factors_.size() == 0) return 1;
  if ((factors_.diagonal().array() == 0).any() || !factors_.allFinite()) return 0;
  const lapack_int n = size_of(factors_.rows());
  std::vector<double> work(4 * pivots_.size());
  std::vector<lapack_int> integers(pivots_.size());
  double result = 0;
  lapack_int info = 0;
  LAPACK_dgecon("1", &n, factors_.data(), &n, &norm_, &result, work.data(), integers.data(), &info);
  return result;
}

bool Lu::is_negative() const {
  bool negative = false;
  for (std::size_t i = 0; i < pivots_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    negative ^= (factors_(row, row) < 0) != (pivots_[i] != static_cast<int>(i) + 1);  // pivots count from 1
  }
  return negative;
}

MatrixXd orthonormal_basis(MatrixXd A) {
  if (A.size() == 0) return A;
  const lapack_int m = size_of(A.rows()), n = size_of(A.cols());
  std::vector<double> reflectors(A.cols());
  lapack_int info = 0;
  with_workspace([&](double* work, lapack_int length) {
    LAPACK_dgeqrf(&m, &n, A.data(), &m, reflectors.data(), work, &length, &info);
    return info;
  });
  with_workspace([&](double* work, lapack_int length) {
    LAPACK_dorgqr(&m, &n, &n, A.data(), &m, reflectors.data(), work, &length, &info);
    return info;
  });
  return A;
}

VectorXd symmetric_eigenvalues(MatrixXd A) { return symmetric("N", A); }

SymmetricEigen symmetric_eigen(MatrixXd A) {
  VectorXd values = symmetric("V", A);
  return {std::move(values), std::move(A)};
}

Eigen::VectorXcd eigenvalues(MatrixXd A) {
  const lapack_int n = size_of(A.rows()), stride = stride_of(A), one = 1;
  VectorXd real(n), imaginary(n);
  const lapack_int info = with_workspace([&](double* work, lapack_int length) {
    lapack_int result = 0;
    LAPACK_dgeev("N", "N", &n, A.data(), &stride, real.data(), imaginary.data(), nullptr, &one, nullptr, &one, work,
                 &length, &result);
    return result;
  });
  if (info != 0) real.setConstant(nan);
  Eigen::VectorXcd values(n);
  values.real() = real;
  values.imag() = imaginary;
  return values;
}

SingularValues singular_values(MatrixXd A) {
  const lapack_int m = size_of(A.rows()), n = size_of(A.cols()), k = std::min(m, n), stride = stride_of(A);
  SingularValues result{MatrixXd(m, k), VectorXd(k), {}};
  MatrixXd V_transposed(k, n);
  const lapack_int stride_U = stride_of(result.U), stride_V = stride_of(V_transposed);
  std::vector<lapack_int> integers(8 * static_cast<std::size_t>(k));
  const lapack_int info = with_workspace([&](double* work, lapack_int length) {
    lapack_int result_info = 0;
    LAPACK_dgesdd("S", &m, &n, A.data(), &stride, result.values.data(), result.U.data(), &stride_U, V_transposed.data(),
                  &stride_V, work, &length, integers.data(), &result_info);
    return result_info;
  });
  if (info != 0) result.values.setConstant(nan);
  result.V = V_transposed.transpose();
  return result;
}

Index SingularValues::rank(double fraction) const {
  return values.size() == 0 ? 0 : (values.array() > fraction * values[0]).count();
}

MatrixXd SingularValues::solve(const MatrixXd& b, double fraction) const {
  const Index n = rank(fraction);
  const MatrixXd along = U.leftCols(n).transpose() * b;
  return V.leftCols(n) * (values.head(n).cwiseInverse().asDiagonal() * along);
}

}  // namespace fastjoint::matrices
