// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// Collects columns of loads over the degrees of freedom.
class Assembler {
 public:
  /// Both must outlive this.
  Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns);

  /// @param values Over modes of an element, local signs, first those of u_x, then those of u_y.
  void add(int element, const std::vector<int>& modes, const Eigen::VectorXd& values, int column);

  /// Rows of the free unknowns, (n_f, n_columns).
  [[nodiscard]] Eigen::SparseMatrix<double> free() const;
  /// Rows of the controlled displacements, (nc, n_columns).
  [[nodiscard]] const Eigen::MatrixXd& controlled() const { return controlled_; }

 private:
  const pfem::Numbering& numbering_;
  const Unknowns& unknowns_;
  std::vector<Eigen::Triplet<double>> free_;
  Eigen::MatrixXd controlled_;
};

}  // namespace fastjoint::stage1
