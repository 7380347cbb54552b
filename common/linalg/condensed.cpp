// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed.hpp"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>

#include "common/errors.hpp"

namespace fastjoint::linalg {
namespace {

int to_int(Eigen::Index n) { return static_cast<int>(n); }

/// A BLAS that is told a leading dimension of 0 complains even of an empty matrix.
int leading(const Eigen::MatrixXd& A) { return std::max(1, to_int(A.rows())); }

}  // namespace

Condensed::Condensed(Eigen::MatrixXd M, Eigen::Index n_inside) : n_(n_inside), M_(std::move(M)) {
  assert(M_.rows() == M_.cols() && n_ <= M_.rows());
  if (n_ == 0) return;
  Eigen::Ref<Eigen::MatrixXd> inside = M_.topLeftCorner(n_, n_);
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(inside).info() != Eigen::Success)
    throw NumericalError("the stiffness matrix of a cell of the plate is not positive definite");
  const int n = to_int(n_), m = to_int(n_outside()), ld = leading(M_);
  double* X = M_.data() + n;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, m, n, 1, M_.data(), ld, X, ld);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, m, n, -1, X, ld, 1, X + n_ * ld, ld);
}

void Condensed::eliminate(Eigen::MatrixXd& inside, Eigen::MatrixXd& outside) const {
  const int n = to_int(n_), m = to_int(n_outside()), k = to_int(inside.cols()), ld = leading(M_);
  if (n == 0 || k == 0) return;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, k, 1, M_.data(), ld, inside.data(),
              leading(inside));
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, k, n, -1, M_.data() + n, ld, inside.data(), leading(inside),
              1, outside.data(), leading(outside));
}

void Condensed::restore(Eigen::MatrixXd& inside, const Eigen::MatrixXd& outside) const {
  const int n = to_int(n_), m = to_int(n_outside()), k = to_int(inside.cols()), ld = leading(M_);
  if (n == 0 || k == 0) return;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, k, m, -1, M_.data() + n, ld, outside.data(), leading(outside),
              1, inside.data(), leading(inside));
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, n, k, 1, M_.data(), ld, inside.data(),
              leading(inside));
}

}  // namespace fastjoint::linalg
