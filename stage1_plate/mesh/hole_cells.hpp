// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Sides of a cell, counter-clockwise.
enum CellSide { bottom, right, top, left };
inline constexpr int n_cell_sides = 4;

/// A hole in its cell of the grid.
struct HoleCell {
  int hole;                             ///< index into PlateScene::holes
  int column, row;                      ///< of the cell
  Eigen::Vector2d center;               ///< on the border to the last digit if the border cuts it
  std::array<bool, n_cell_sides> cuts;  ///< sides that run through the centre (lines of symmetry)
};

/// Cell of every hole. Throws InputError for a hole outside the plate or over a cell line, and for two in one cell.
[[nodiscard]] std::vector<HoleCell> find_hole_cells(const PlateScene& scene, const GridGeometry& grid);

}  // namespace fastjoint::stage1
