// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed_stiffness.hpp"

#include "common/linalg/condensed.hpp"

namespace fastjoint::linalg {

Eigen::MatrixXd condensed_stiffness(const Eigen::MatrixXd& E_c, const Eigen::VectorXd& shift,
                                    const Eigen::MatrixXd& K_cc) {
  Eigen::MatrixXd S = product_transposed(E_c, E_c);
  S.diagonal() -= shift;
  S.triangularView<Eigen::StrictlyUpper>() = S.transpose();  // a product by blocks is symmetric but for its last digits
  constexpr double rounding = 1e-12;
  const auto largest = [](const Eigen::MatrixXd& A) { return A.size() > 0 ? A.cwiseAbs().maxCoeff() : 0; };
  if (largest(S) < rounding * largest(K_cc)) S.setZero();
  return S;
}

}  // namespace fastjoint::linalg
