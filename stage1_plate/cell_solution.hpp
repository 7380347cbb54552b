// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage1_plate/condensed_cell.hpp"
#include "stage1_plate/outline.hpp"

namespace fastjoint::stage1 {

/// Coefficients of one cell while the plate is solved: loads inside it are eliminated before the outline is solved,
/// displacements inside it follow from those of the outline.
class CellSolution {
 public:
  /// All must outlive this. @param elements Of unit thickness, by element shape.
  CellSolution(const PlateProblem& problem, const Cell& cell, const CondensedCell& condensed,
               const std::vector<linalg::Condensed>& elements, const ElementModes& modes, const Outline::Rows& rows);

  /// @param B Loads on the plate's unknowns, (n_p, k).
  void eliminate(const Eigen::Ref<const Eigen::MatrixXd>& B);
  /// Adds what they do to the loads on the outline.
  void add_to(Eigen::MatrixXd& outline) const;
  /// @param outline Displacements of the outline. @param X (n_p, k) gets those inside the cell.
  void restore(const Eigen::MatrixXd& outline, Eigen::Ref<Eigen::MatrixXd> X);

 private:
  [[nodiscard]] int target(int coefficient) const;
  [[nodiscard]] double sign(int coefficient) const { return cell_.sign[coefficient / 2]; }
  /// Rows of an element's coefficients of these modes, first all of u_x; signs between element and cell.
  struct Place {
    std::vector<int> coefficient;
    Eigen::VectorXd sign;
  };
  [[nodiscard]] Place place(std::size_t element, const std::vector<int>& modes) const;

  const PlateProblem& problem_;
  const Cell& cell_;
  const CellShape& shape_;
  const CondensedCell& condensed_;
  const std::vector<linalg::Condensed>& elements_;
  const ElementModes& modes_;
  const Outline::Rows& rows_;
  bool loaded_ = false;                    ///< whether anything acts inside
  Eigen::MatrixXd inside_, outside_;       ///< between eliminate and restore
  std::vector<Eigen::MatrixXd> interior_;  ///< of each element
};

}  // namespace fastjoint::stage1
