// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// Collects columns over the degrees of freedom: loads, or what couples each controlled displacement to all of them.
/// Values over modes of an element are given with local signs, first those of u_x, then those of u_y.
class Assembler {
 public:
  /// Both must outlive this.
  Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns);

  void add(int dof, int column, double value);
  void add(int element, const std::vector<int>& modes, const Eigen::VectorXd& values, int column);

  /// Adds factor K over modes of an element, shape (2n, 2n); what it has between free unknowns is left out.
  void add_stiffness(int element, const std::vector<int>& modes, const Eigen::MatrixXd& K, double factor);
  /// Adds stiffness between a degree of freedom and a controlled displacement, or modes of an element and one.
  void add_coupling(int dof, int controlled, double value);
  void add_coupling(int element, const std::vector<int>& modes, const Eigen::VectorXd& values, int controlled);
  /// Adds a spring between a degree of freedom and a controlled displacement.
  void add_spring(int dof, int controlled, double stiffness);

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
