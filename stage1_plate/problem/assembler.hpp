// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// Rows of a column of loads, or of a disc, in terms of an element's coefficients.
struct ElementVector {
  std::vector<int> modes;   ///< (n) local modes
  Eigen::Matrix2Xd values;  ///< (2, n) for u_x and u_y of each, local signs
};

/// Collects what couples free (f) and controlled (c) unknowns, and controlled ones with each other.
class Assembler {
 public:
  Assembler(const pfem::Numbering& numbering, const Unknowns& unknowns);

  /// factor K over some modes of an element, shape (2n, 2n), first all of u_x, local signs. What it has between free
  /// unknowns is left out.
  void add_stiffness(int element, const std::vector<int>& modes, const Eigen::MatrixXd& K, double factor);
  /// Stiffness between an element's coefficients and a controlled displacement.
  void add_coupling(int element, const ElementVector& g, int controlled);
  /// A spring between a coefficient of the plate, by its target, and a controlled displacement.
  void add_spring(int target, int controlled, double stiffness);
  void add_controlled(int i, int j, double value) { K_cc_(i, j) += value; }

  [[nodiscard]] Eigen::SparseMatrix<double> K_fc() const;
  [[nodiscard]] const Eigen::MatrixXd& K_cc() const { return K_cc_; }

 private:
  const pfem::Numbering& numbering_;
  const Unknowns& unknowns_;
  std::vector<Eigen::Triplet<double>> fc_;
  Eigen::MatrixXd K_cc_;
};

/// Collects columns of loads.
class LoadAssembler {
 public:
  LoadAssembler(const pfem::Numbering& numbering, const Unknowns& unknowns, int n_columns);
  void add(int element, const ElementVector& g, int column);
  [[nodiscard]] Eigen::SparseMatrix<double> free() const;
  [[nodiscard]] const Eigen::MatrixXd& controlled() const { return controlled_; }

 private:
  const pfem::Numbering& numbering_;
  const Unknowns& unknowns_;
  std::vector<Eigen::Triplet<double>> free_;
  Eigen::MatrixXd controlled_;
};

}  // namespace fastjoint::stage1
