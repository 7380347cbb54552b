// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "stage1_plate/mesh/crack_mesh.hpp"
#include "stage1_plate/mesh/crack_places.hpp"
#include "stage1_plate/mesh/grid_cells.hpp"

namespace fastjoint::stage1 {

/// A tip inside the cell of a hole, on a ray from the hole's centre.
struct CellTip {
  double angle;   ///< of the ray, radians
  double radius;  ///< distance from the centre, length
  double size;    ///< of the elements around the tip, length
};

/// What cracks ask of the mesh of a grid.
struct GridCracks {
  SideNodes nodes;                         ///< where they and their tips need mesh lines
  std::vector<std::vector<CellTip>> tips;  ///< inside the cell of each hole, in the order of the cells
};

/// Plans the mesh lines of the scene's cracks. Throws InputError for a crack that runs through a hole, or that runs
/// through the cell of a hole but not towards its centre.
[[nodiscard]] GridCracks plan_cracks(const PlateScene& scene, const GridGeometry& grid,
                                     const std::vector<HoleCell>& holes,
                                     const std::vector<std::vector<TipPlace>>& tips);

/// Radial coordinates of the layers of elements in the cell of a hole with tips: for each layer one for each ray.
/// @param outline Points of the cell's outline, one on each ray. @param nearest Distance to the nearest side.
[[nodiscard]] std::vector<Eigen::VectorXd> tip_layers(const std::vector<CellTip>& tips, double radius,
                                                      const Eigen::Vector2d& center,
                                                      const std::vector<Eigen::Vector2d>& outline, double nearest);

/// The edges of the mesh along each crack.
[[nodiscard]] std::vector<CrackPath> crack_paths(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
