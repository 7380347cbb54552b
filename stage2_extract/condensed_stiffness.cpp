// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/condensed_stiffness.hpp"

namespace fastjoint::stage2 {

Eigen::MatrixXd condensed_stiffness(const formats::PlateSolution& plate, std::size_t level) {
  const auto& U = plate.cases[level].U;
  return plate.K_cc + plate.K_fc.topRows(U.rows()).transpose() * U;
}

}  // namespace fastjoint::stage2
