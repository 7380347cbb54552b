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

/// A cell of the grid.
struct Cell {
  std::array<int, 2> index;   ///< column and row
  Eigen::Vector2d low, high;  ///< corners bottom left and top right
};
[[nodiscard]] Cell cell_at(const GridGeometry& grid, int column, int row);

/// A hole in its cell.
struct HoleCell : Cell {
  int hole;                             ///< index into PlateScene::holes
  Eigen::Vector2d center;               ///< exactly on the plate's edge if the edge cuts the hole
  std::array<bool, n_cell_sides> cuts;  ///< sides that run through the centre (lines of symmetry)
};

/// Finds the cell of every hole. Throws InputError for a hole outside the plate or over a cell line, and for two in one
/// cell.
[[nodiscard]] std::vector<HoleCell> find_hole_cells(const PlateScene& scene, const GridGeometry& grid);

/// Something for each side of the cells of a grid: [0][row][line of x] for left and right sides, [1][column][line of y]
/// for bottom and top.
template <typename Value>
using OfSides = std::array<std::vector<std::vector<Value>>, 2>;

/// Lines of a mesh at tips are left out that are nearer to another than this share of the step to the line before.
inline constexpr double sliver = 0.3;

/// A node that cracks need on a side of a cell.
struct CrackNode {
  double at;    ///< coordinate along the side, x on bottom and top, else y
  double step;  ///< size of the elements there, length; 0 for a node on the line of a crack or its tip, which must be
                ///< there
};

/// Nodes between the ends of cell sides: coordinates along each side, ascending.
struct SideNodes {
  OfSides<std::vector<double>> on;

  [[nodiscard]] const std::vector<double>& of(const Cell& cell, CellSide side) const;
};

/// Nodes between the ends of every cell side, the same for both neighbouring cells.
///
/// The cell of a hole needs a node where the hole's centre line meets each of its sides, so that its fan has two
/// sectors in every quarter, and another where such a sector is wider than 60 degrees, as next to a near edge: wide
/// sectors resolve few waves. Any other node on its outline adds a ray to the fan. A cell without a hole is cut by
/// straight lines, so a node continues to the opposite side, and so on up to the next hole or the plate's edge.
/// Nodes that cracks need take the place of those of holes close to them.
[[nodiscard]] SideNodes place_nodes(const PlateScene& scene, const GridGeometry& grid,
                                    const std::vector<HoleCell>& holes,
                                    const OfSides<std::vector<CrackNode>>& of_cracks);

}  // namespace fastjoint::stage1
