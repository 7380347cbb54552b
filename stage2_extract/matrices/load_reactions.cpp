// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/load_reactions.hpp"

#include "common/linalg/condensed.hpp"

namespace fastjoint::stage2 {
Eigen::MatrixXd friction_reactions(const formats::PlateSolution& plate, std::size_t level) {
  return linalg::product_transposed(plate.cases[level].E_c, plate.cases[level].E_h);
}

Eigen::MatrixXd traction_reactions(const formats::PlateSolution& plate, std::size_t level) {
  const auto& V = plate.cases[level].V;
  return plate.K_fc.topRows(V.rows()).transpose() * V - plate.T_c;
}

Eigen::MatrixXd traction_compliance(const formats::PlateSolution& plate, std::size_t level) {
  const auto& V = plate.cases[level].V;
  return plate.T_f.topRows(V.rows()).transpose() * V;
}

}  // namespace fastjoint::stage2
