// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// Quadrilaterals for a grid of cells with holes, without rims: a cell with a hole becomes a fan of ring elements from
/// the hole's arcs to the cell's outline (and extra rings, graded towards the hole), any other cell rectangles.
/// The mesh is conforming; the sets "left", "right", "bottom", "top" are the sides on the border.
[[nodiscard]] PlateMesh mesh_grid(const PlateScene& scene, const GridGeometry& grid);

}  // namespace fastjoint::stage1
