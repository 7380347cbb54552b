// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Sides of a cell, counter-clockwise.
enum CellSide { bottom, right, top, left };
inline constexpr int n_cell_sides = 4;

/// A hole in its cell of the grid.
struct HoleCell {
  int hole;                             ///< index into PlateScene::holes
  int column, row;                      ///< indices of the cell
  Eigen::Vector2d center;               ///< exactly on the plate's edge if the edge cuts the hole
  std::array<bool, n_cell_sides> cuts;  ///< sides that run through the centre (lines of symmetry)
};

/// Finds the cell of every hole. Throws InputError for a hole outside the plate or over a cell line, and for two in one
/// cell.
[[nodiscard]] std::vector<HoleCell> find_hole_cells(const PlateScene& scene, const GridGeometry& grid);

/// Nodes that cracks need on the sides of cells.
class FixedNodes {
 public:
  FixedNodes() = default;
  explicit FixedNodes(const GridGeometry& grid);

  /// Adds a node to a side.
  /// @param axis  0 for left and right sides, whose strip is a row; 1 for bottom and top, whose strip is a column.
  /// @param line  Index of the cell line that the side is on. @param at Coordinate along the side, length.
  void add(int axis, int strip, int line, double at) {
    (axis == 0 ? vertical_ : horizontal_)[strip][line].push_back(at);
  }
  /// [column][line] and [row][line] lists of coordinates, in no order.
  using Sides = std::vector<std::vector<std::vector<double>>>;
  [[nodiscard]] const Sides& horizontal() const { return horizontal_; }
  [[nodiscard]] const Sides& vertical() const { return vertical_; }

 private:
  Sides horizontal_, vertical_;
};

/// Nodes between the ends of every cell side, the same for both neighbouring cells.
///
/// The cell of a hole needs a node where the hole's centre line meets each of its sides, so that its fan has two
/// sectors in every quarter, and another where such a sector is wider than 60 degrees, as next to a near edge: wide
/// sectors resolve few waves. Any other node on its outline adds a ray to the fan. A cell without a hole is cut by
/// straight lines, so a node continues to the opposite side, and so on up to the next hole or the plate's edge.
/// Nodes that cracks need take the place of those of holes close to them.
class CellLines {
 public:
  CellLines(const PlateScene& scene, const GridGeometry& grid, const std::vector<HoleCell>& holes,
            const FixedNodes& fixed);

  /// Coordinates strictly between the ends of a side of cell (column, row), ascending: x on bottom and top, else y.
  [[nodiscard]] const std::vector<double>& nodes(int column, int row, CellSide side) const;

 private:
  using Nodes = std::vector<double>;
  std::vector<std::vector<Nodes>> horizontal_;  ///< [column][line], line = 0 .. number of rows
  std::vector<std::vector<Nodes>> vertical_;    ///< [row][line]
};

}  // namespace fastjoint::stage1
