// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/condensed_stiffness.hpp"

#include "common/linalg/condensed.hpp"

namespace fastjoint::stage2 {

Eigen::MatrixXd condensed_stiffness(const formats::PlateSolution& plate, std::size_t level) {
  const auto& E = plate.cases[level].E_c;
  Eigen::MatrixXd S = linalg::product_transposed(E, E);
  S.diagonal() -= plate.shift;
  S.triangularView<Eigen::StrictlyUpper>() = S.transpose();  // a product by blocks is symmetric but for its last digits
  constexpr double rounding = 1e-12;
  const auto largest = [](const Eigen::MatrixXd& A) { return A.size() > 0 ? A.cwiseAbs().maxCoeff() : 0; };
  if (largest(S) < rounding * largest(plate.K_cc)) S.setZero();
  return S;
}

}  // namespace fastjoint::stage2
