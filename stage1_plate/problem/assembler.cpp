// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/assembler.hpp"

namespace fastjoint::stage1 {

Assembler::Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns)
    : numbering_(numbering),
      unknowns_(unknowns),
      controlled_(Eigen::MatrixXd::Zero(unknowns.n_controlled(), n_columns)) {}

void Assembler::add(int dof, int column, double value) {
  if (pfem::is_free(dof)) free_.emplace_back(dof, column, value);
  if (pfem::is_controlled(dof)) controlled_(pfem::controlled_index(dof), column) += value;
}

void Assembler::add(int element, const std::vector<int>& modes, const Eigen::VectorXd& values, int column) {
  const auto [dof, sign] = pfem::element_dofs(numbering_, unknowns_.dofs, element, modes);
  for (Eigen::Index i = 0; i < dof.size(); ++i) add(dof[i], column, sign[i] * values[i]);
}

void Assembler::add_stiffness(int element, const std::vector<int>& modes, const Eigen::MatrixXd& K, double factor) {
  const auto [dof, sign] = pfem::element_dofs(numbering_, unknowns_.dofs, element, modes);
  for (Eigen::Index j = 0; j < dof.size(); ++j)
    if (pfem::is_controlled(dof[j]))
      for (Eigen::Index i = 0; i < dof.size(); ++i)
        add(dof[i], pfem::controlled_index(dof[j]), factor * sign[i] * sign[j] * K(i, j));
}

void Assembler::add_coupling(int dof, int controlled, double value) {
  add(dof, controlled, value);
  if (pfem::is_controlled(dof)) add(pfem::controlled_dof(controlled), pfem::controlled_index(dof), value);
}

void Assembler::add_coupling(int element, const std::vector<int>& modes, const Eigen::VectorXd& values,
                             int controlled) {
  const auto [dof, sign] = pfem::element_dofs(numbering_, unknowns_.dofs, element, modes);
  for (Eigen::Index i = 0; i < dof.size(); ++i) add_coupling(dof[i], controlled, sign[i] * values[i]);
}

void Assembler::add_spring(int dof, int controlled, double stiffness) {
  add(pfem::controlled_dof(controlled), controlled, stiffness);
  add_coupling(dof, controlled, -stiffness);
  if (pfem::is_controlled(dof)) add(dof, pfem::controlled_index(dof), stiffness);
}

Eigen::SparseMatrix<double> Assembler::free() const {
  Eigen::SparseMatrix<double> A(unknowns_.n_free.back(), controlled_.cols());
  A.setFromTriplets(free_.begin(), free_.end());
  return A;
}

}  // namespace fastjoint::stage1
