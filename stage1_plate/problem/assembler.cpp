// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/assembler.hpp"

namespace fastjoint::stage1 {
namespace {

int target(const pfem::Numbering& numbering, const Unknowns& unknowns, int element, Eigen::Index mode, int component) {
  return unknowns.target[2 * numbering.function(mode, element) + component];
}

Eigen::SparseMatrix<double> compressed(const std::vector<Eigen::Triplet<double>>& triplets, int rows, int cols) {
  Eigen::SparseMatrix<double> A(rows, cols);
  A.setFromTriplets(triplets.begin(), triplets.end());
  return A;
}

}  // namespace

Assembler::Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns)
    : numbering_(numbering), unknowns_(unknowns), K_cc_(unknowns.n_controlled, unknowns.n_controlled) {
  K_cc_.setZero();
}

void Assembler::add_stiffness(int element, const std::vector<int>& modes, const Eigen::MatrixXd& K, double factor) {
  const Eigen::Index n = modes.size();
  const auto mode = [&](Eigen::Index i) { return modes[i % n]; };
  const auto to = [&](Eigen::Index i) { return target(numbering_, unknowns_, element, mode(i), i < n ? 0 : 1); };
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    if (!Unknowns::is_controlled(to(j))) continue;
    const int controlled = Unknowns::controlled_index(to(j));
    for (Eigen::Index i = 0; i < 2 * n; ++i) {
      const double value = factor * numbering_.sign(mode(i), element) * numbering_.sign(mode(j), element) * K(i, j);
      if (Unknowns::is_free(to(i))) fc_.emplace_back(to(i), controlled, value);
      if (Unknowns::is_controlled(to(i))) K_cc_(Unknowns::controlled_index(to(i)), controlled) += value;
    }
  }
}

void Assembler::add_coupling(int element, const ElementVector& g, int controlled) {
  for (std::size_t i = 0; i < g.modes.size(); ++i)
    for (int component = 0; component < 2; ++component) {
      const int row = target(numbering_, unknowns_, element, g.modes[i], component);
      const double value = numbering_.sign(g.modes[i], element) * g.values(component, i);
      if (row == Unknowns::fixed) continue;
      if (Unknowns::is_free(row)) {
        fc_.emplace_back(row, controlled, value);
      } else {
        K_cc_(Unknowns::controlled_index(row), controlled) += value;
        K_cc_(controlled, Unknowns::controlled_index(row)) += value;
      }
    }
}

void Assembler::add_spring(int target, int controlled, double stiffness) {
  K_cc_(controlled, controlled) += stiffness;
  if (Unknowns::is_free(target)) {
    fc_.emplace_back(target, controlled, -stiffness);
  } else if (target != Unknowns::fixed) {
    const int other = Unknowns::controlled_index(target);
    K_cc_(other, other) += stiffness;
    K_cc_(other, controlled) -= stiffness;
    K_cc_(controlled, other) -= stiffness;
  }
}

Eigen::SparseMatrix<double> Assembler::K_fc() const {
  return compressed(fc_, unknowns_.n_free.back(), unknowns_.n_controlled);
}

LoadAssembler::LoadAssembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns)
    : numbering_(numbering), unknowns_(unknowns), controlled_(unknowns.n_controlled, n_columns) {
  controlled_.setZero();
}

void LoadAssembler::add(int element, const ElementVector& g, int column) {
  for (std::size_t i = 0; i < g.modes.size(); ++i)
    for (int component = 0; component < 2; ++component) {
      const int row = target(numbering_, unknowns_, element, g.modes[i], component);
      const double value = numbering_.sign(g.modes[i], element) * g.values(component, i);
      if (Unknowns::is_free(row)) {
        free_.emplace_back(row, column, value);
      } else if (row != Unknowns::fixed) {
        controlled_(Unknowns::controlled_index(row), column) += value;
      }
    }
}

Eigen::SparseMatrix<double> LoadAssembler::free() const {
  return compressed(free_, unknowns_.n_free.back(), static_cast<int>(controlled_.cols()));
}

}  // namespace fastjoint::stage1
