// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed.hpp"

#include <cassert>

#include "common/errors.hpp"

extern "C" {  // BLAS and LAPACK as Fortran has them
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha, const double* a,
            const int* lda, const double* beta, double* c, const int* ldc);
void dgemm_(const char* trans_a, const char* trans_b, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
}

namespace fastjoint::linalg {
namespace {

constexpr double one = 1, minus_one = -1, zero = 0;

int to_int(Eigen::Index n) { return static_cast<int>(n); }

/// A BLAS that is told a leading dimension of 0 complains even of an empty matrix.
int leading(const Eigen::MatrixXd& A) { return std::max(1, to_int(A.rows())); }

}  // namespace

Condensed::Condensed(Eigen::MatrixXd M, Eigen::Index n_inside) : n_(n_inside), M_(std::move(M)) {
  assert(M_.rows() == M_.cols() && n_ <= M_.rows());
  if (n_ == 0) return;
  const int n = to_int(n_), m = to_int(n_outside()), ld = leading(M_);
  int info = 0;
  dpotrf_("L", &n, M_.data(), &ld, &info);
  if (info != 0) throw NumericalError("the stiffness matrix of a cell of the plate is not positive definite");
  if (m == 0) return;
  double* X = M_.data() + n;
  dtrsm_("R", "L", "T", "N", &m, &n, &one, M_.data(), &ld, X, &ld);
  dsyrk_("L", "N", &m, &n, &minus_one, X, &ld, &one, M_.data() + n_ * ld + n_, &ld);
}

void Condensed::eliminate(Eigen::MatrixXd& inside, Eigen::MatrixXd& outside) const {
  const int n = to_int(n_), m = to_int(n_outside()), k = to_int(inside.cols()), ld = leading(M_);
  if (n == 0 || k == 0) return;
  const int ld_in = leading(inside), ld_out = leading(outside);
  dtrsm_("L", "L", "N", "N", &n, &k, &one, M_.data(), &ld, inside.data(), &ld_in);
  dgemm_("N", "N", &m, &k, &n, &minus_one, M_.data() + n, &ld, inside.data(), &ld_in, &one, outside.data(), &ld_out);
}

void Condensed::restore(Eigen::MatrixXd& inside, const Eigen::MatrixXd& outside) const {
  const int n = to_int(n_), m = to_int(n_outside()), k = to_int(inside.cols()), ld = leading(M_);
  if (n == 0 || k == 0) return;
  const int ld_in = leading(inside), ld_out = leading(outside);
  dgemm_("T", "N", &n, &k, &m, &minus_one, M_.data() + n, &ld, outside.data(), &ld_out, &one, inside.data(), &ld_in);
  dtrsm_("L", "L", "T", "N", &n, &k, &one, M_.data(), &ld, inside.data(), &ld_in);
}

Eigen::MatrixXd product_transposed(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  assert(A.cols() == B.cols());
  Eigen::MatrixXd C(A.rows(), B.rows());
  const int m = to_int(A.rows()), n = to_int(B.rows()), k = to_int(A.cols());
  const int ld_a = leading(A), ld_b = leading(B), ld_c = leading(C);
  dgemm_("N", "T", &m, &n, &k, &one, A.data(), &ld_a, B.data(), &ld_b, &zero, C.data(), &ld_c);
  return C;
}

}  // namespace fastjoint::linalg
