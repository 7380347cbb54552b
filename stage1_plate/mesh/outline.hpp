// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// A straight piece of a sheet's outline.
struct OutlinePiece {
  Eigen::Vector2d from, to;
  bool is_free;  ///< false where a support or an external is, and the sheet or its mirror image may go on
};

/// The outline of the sheet without holes and cracks, arcs as chords.
[[nodiscard]] std::vector<OutlinePiece> outline_of(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
