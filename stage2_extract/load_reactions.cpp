// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/load_reactions.hpp"

namespace fastjoint::stage2 {
namespace {

Eigen::MatrixXd reactions(const Eigen::MatrixXd& U, const Eigen::SparseMatrix<double>& load_f,
                          const Eigen::MatrixXd& load_c) {
  return -((load_f.topRows(U.rows()).transpose() * U).transpose() + load_c);
}

}  // namespace

Eigen::MatrixXd friction_reactions(const formats::PlateSolution& plate, std::size_t level) {
  return reactions(plate.cases[level].U, plate.L_f, plate.L_c);
}

Eigen::MatrixXd traction_reactions(const formats::PlateSolution& plate, std::size_t level) {
  return reactions(plate.cases[level].U, plate.T_f, plate.T_c);
}

Eigen::MatrixXd traction_compliance(const formats::PlateSolution& plate, std::size_t level) {
  const auto& V = plate.cases[level].V;
  return plate.T_f.topRows(V.rows()).transpose() * V;
}

}  // namespace fastjoint::stage2
