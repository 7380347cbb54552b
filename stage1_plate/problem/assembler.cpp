// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/assembler.hpp"

namespace fastjoint::stage1 {

Assembler::Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns)
    : numbering_(numbering),
      unknowns_(unknowns),
      controlled_(Eigen::MatrixXd::Zero(unknowns.n_controlled(), n_columns)) {}

void Assembler::add(int element, const std::vector<int>& modes, const Eigen::VectorXd& values, int column) {
  const auto [dof, sign] = pfem::element_dofs(numbering_, unknowns_.dofs, element, modes);
  for (Eigen::Index i = 0; i < dof.size(); ++i) {
    const double value = sign[i] * values[i];
    if (pfem::is_free(dof[i])) free_.emplace_back(dof[i], column, value);
    if (pfem::is_controlled(dof[i])) controlled_(pfem::controlled_index(dof[i]), column) += value;
  }
}

Eigen::SparseMatrix<double> Assembler::free() const {
  Eigen::SparseMatrix<double> A(unknowns_.n_free.back(), controlled_.cols());
  A.setFromTriplets(free_.begin(), free_.end());
  return A;
}

}  // namespace fastjoint::stage1
