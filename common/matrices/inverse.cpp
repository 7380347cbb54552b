// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/matrices/inverse.hpp"

#include <algorithm>
#include <complex>

// The header would take C's complex numbers, and with them a macro named I.
#define lapack_complex_float std::complex<float>
#define lapack_complex_double std::complex<double>
#include <lapacke.h>

namespace fastjoint::matrices {

std::optional<Eigen::MatrixXd> inverse_of_positive(Eigen::MatrixXd A) {
  const auto n = static_cast<lapack_int>(A.rows());
  const lapack_int stride = std::max<lapack_int>(n, 1);
  lapack_int info = 0;
  LAPACK_dpotrf("L", &n, A.data(), &stride, &info);
  if (info == 0) LAPACK_dpotri("L", &n, A.data(), &stride, &info);
  if (info != 0) return std::nullopt;
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  return A;
}

}  // namespace fastjoint::matrices
