// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// The outline of the sheet without holes and cracks, arcs as chords.
[[nodiscard]] std::vector<pfem::OutlinePiece> outline_of(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
