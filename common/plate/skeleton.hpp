// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "common/plate/plate_stiffness.hpp"

namespace fastjoint::plate {

/// Blocks of unknowns in the order of elimination: the vertices and edges on the skeletons of the elements, then the
/// border (controlled displacements, waves and friction cases, each a block). The order is the same for all degrees.
class Skeleton {
 public:
  explicit Skeleton(const PlateStiffness& plate);

  /// Rows of the bordered skeleton stiffness at one degree.
  struct Rows {
    std::vector<int> of_unknown;  ///< (n_f) row of a free unknown, -1 if it is interior or of a higher degree
    std::vector<int> first;       ///< (blocks + 1) first row of each block
    int n_skeleton, n_border;

    /// Row of a degree of freedom, or -1 for a fixed one.
    [[nodiscard]] int of_dof(int dof) const;
  };
  /// @param plate    The plate of the constructor, or one with the same unknowns.
  /// @param n_border Number of leading columns of the border to include.
  [[nodiscard]] Rows rows(const PlateStiffness& plate, int p, int n_border) const;
  /// Numbers of entries of the bordered skeleton stiffness, of its factor, of the factor's largest front, and the peak
  /// storage of forward elimination of the border's rows (linalg::Cholesky::products).
  struct Size {
    double entries, factor, largest_front, elimination;
  };
  [[nodiscard]] Size size(const Rows& rows) const;
  /// Pattern of the lower triangle of the bordered skeleton stiffness, with values of zero.
  [[nodiscard]] Eigen::SparseMatrix<double> pattern(const Rows& rows) const;

 private:
  using Blocks = std::vector<int>;
  void order(const std::vector<Blocks>& on_skeleton);
  void join(const Blocks& clique);

  std::vector<int> position_;   ///< (vertices, edges) block, or -1
  std::vector<int> function_;   ///< (blocks before the border) first function: vertex, or edge mode 2
  std::vector<Blocks> higher_;  ///< (blocks) later blocks that share an element with it, ascending
};

}  // namespace fastjoint::plate
