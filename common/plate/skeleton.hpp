// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "common/plate/plate_stiffness.hpp"

namespace fastjoint::plate {

/// The vertices and edges on the skeletons of the elements as blocks of unknowns, in the order in which they are
/// eliminated, and behind them the border: the controlled displacements, the waves and the friction cases, each a
/// block. Ordered once for all degrees.
class Skeleton {
 public:
  explicit Skeleton(const PlateStiffness& plate);

  /// Rows of the bordered skeleton stiffness at one degree.
  struct Rows {
    std::vector<int> of_unknown;  ///< (n_f) row of a free unknown, or -1 of one inside an element or of a higher degree
    std::vector<int> first;       ///< (blocks + 1) of each block
    int n_skeleton, n_border;

    /// Row of a degree of freedom, or -1 for a fixed one.
    [[nodiscard]] int of_dof(int dof) const;
  };
  /// @param plate    That of the constructor, or one with the same unknowns.
  /// @param n_border Number of columns of the border that count, the first ones.
  [[nodiscard]] Rows rows(const PlateStiffness& plate, int p, int n_border) const;
  /// Entries of the bordered skeleton stiffness, of its factor, of the factor's largest front, and the most that
  /// forward elimination of the border's rows holds at once (linalg::Cholesky::products).
  struct Size {
    double entries, factor, largest_front, elimination;
  };
  [[nodiscard]] Size size(const Rows& rows) const;
  /// Pattern of the bordered skeleton stiffness, its lower triangle, all values zero.
  [[nodiscard]] Eigen::SparseMatrix<double> pattern(const Rows& rows) const;

 private:
  using Blocks = std::vector<int>;
  void order(const std::vector<Blocks>& on_skeleton);
  void join(const Blocks& clique);

  std::vector<int> position_;   ///< (vertices, edges) block, or -1
  std::vector<int> function_;   ///< (blocks before the border) its first function: vertex, or edge mode 2
  std::vector<Blocks> higher_;  ///< (blocks) later blocks that share an element with it, ascending
};

}  // namespace fastjoint::plate
