// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/condensed_stiffness.hpp"

namespace fastjoint::stage2 {

Eigen::MatrixXd condensed_stiffness(const formats::PlateSolution& plate, std::size_t level) {
  const auto& U = plate.cases[level].U;
  Eigen::MatrixXd S = plate.K_cc + plate.K_fc.topRows(U.rows()).transpose() * U;
  constexpr double rounding = 1e-12;
  const auto largest = [](const Eigen::MatrixXd& A) { return A.size() > 0 ? A.cwiseAbs().maxCoeff() : 0; };
  if (largest(S) < rounding * largest(plate.K_cc)) S.setZero();
  return S;
}

}  // namespace fastjoint::stage2
