// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/assembler.hpp"

namespace fastjoint::stage1 {
namespace {

int target(const pfem::Numbering& numbering, const Unknowns& unknowns, int element, Eigen::Index mode, int component) {
  return unknowns.target[static_cast<std::size_t>(2 * numbering.function(mode, element) + component)];
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
  const auto n_modes = static_cast<std::size_t>(numbering.function.rows());
  ff_.reserve(static_cast<std::size_t>(numbering.function.cols()) * n_modes * (2 * n_modes + 1));
}

void Assembler::add_stiffness(int element, const Eigen::MatrixXd& K, double factor) {
  const auto n = numbering_.function.rows();
  std::vector<int> to(static_cast<std::size_t>(2 * n));
  Eigen::VectorXd sign(2 * n);
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    to[static_cast<std::size_t>(i)] = target(numbering_, unknowns_, element, i % n, i < n ? 0 : 1);
    sign[i] = numbering_.sign(i % n, element);
  }
  for (Eigen::Index j = 0; j < 2 * n; ++j)
    for (Eigen::Index i = 0; i < 2 * n; ++i) {
      const int row = to[static_cast<std::size_t>(i)];
      const int col = to[static_cast<std::size_t>(j)];
      if (row == Unknowns::fixed || col == Unknowns::fixed) continue;
      const double value = factor * sign[i] * sign[j] * K(i, j);
      if (Unknowns::is_free(row) && Unknowns::is_free(col)) {
        if (row >= col) ff_.emplace_back(row, col, value);
      } else if (Unknowns::is_free(row)) {
        fc_.emplace_back(row, Unknowns::controlled_index(col), value);
      } else if (!Unknowns::is_free(col)) {
        K_cc_(Unknowns::controlled_index(row), Unknowns::controlled_index(col)) += value;
      }
    }
}

void Assembler::add_coupling(int element, const ElementVector& g, int controlled) {
  for (std::size_t i = 0; i < g.modes.size(); ++i)
    for (int component = 0; component < 2; ++component) {
      const int row = target(numbering_, unknowns_, element, g.modes[i], component);
      const double value = numbering_.sign(g.modes[i], element) * g.values(component, static_cast<Eigen::Index>(i));
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
    ff_.emplace_back(target, target, stiffness);
    fc_.emplace_back(target, controlled, -stiffness);
  } else if (target != Unknowns::fixed) {
    const int other = Unknowns::controlled_index(target);
    K_cc_(other, other) += stiffness;
    K_cc_(other, controlled) -= stiffness;
    K_cc_(controlled, other) -= stiffness;
  }
}

Eigen::SparseMatrix<double> Assembler::K_ff() const {
  return compressed(ff_, unknowns_.n_free.back(), unknowns_.n_free.back());
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
      const double value = numbering_.sign(g.modes[i], element) * g.values(component, static_cast<Eigen::Index>(i));
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
