// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "stage1_plate/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Columns of the border that act on an element, in the order in which it has them (CondensedElement): of each of its
/// holes the discs, then the friction cases. Controlled displacements count from 0, friction cases behind them.
[[nodiscard]] std::vector<int> border_of(const PlateProblem& problem, int element);

/// The vertices and edges on the outlines of the elements as blocks of unknowns, in the order in which they are
/// eliminated, and behind them the border: the controlled displacements, then the friction cases, each a block. Ordered
/// once for all degrees. The problem must outlive this.
class Outline {
 public:
  explicit Outline(const PlateProblem& problem);

  /// Rows of the bordered outline stiffness at one degree.
  struct Rows {
    std::vector<int> of_unknown;  ///< (n_f) row of a free unknown, or -1 of one inside an element or of a higher degree
    std::vector<int> first;       ///< (blocks + 1) of each block
    int n_outline, n_border;

    /// Of a target (Unknowns), or -1 of a fixed one.
    [[nodiscard]] int of_target(int target) const;
  };
  [[nodiscard]] Rows rows(int p) const;
  /// Entries of the bordered outline stiffness, of its factor and of the factor's largest front.
  struct Size {
    double entries, factor, largest_front;
  };
  [[nodiscard]] Size size(const Rows& rows) const;
  /// Pattern of the bordered outline stiffness, its lower triangle, all values zero.
  [[nodiscard]] Eigen::SparseMatrix<double> pattern(const Rows& rows) const;

 private:
  using Blocks = std::vector<int>;
  void order(const std::vector<Blocks>& on_outline);
  void join(const Blocks& clique);

  const PlateProblem& problem_;
  std::vector<int> position_;   ///< (vertices, edges) block, or -1
  std::vector<int> function_;   ///< (blocks before the border) its first function: vertex, or edge mode 2
  std::vector<Blocks> higher_;  ///< (blocks) later blocks that share an element with it, ascending
};

}  // namespace fastjoint::stage1
