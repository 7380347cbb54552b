// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// Finds the edges that an explicit mesh names: its sets on the border, and its sections, whose sides are those of the
/// elements between the cut and the hole (on a border, of the only element there is). Throws InputError if no element
/// has such an edge, an edge of a set is inside the plate, or the edges of a section are not straight, not on one line
/// across the section's direction, or not beyond the rim on that side of the hole.
void name_edges(const PlateScene& scene, const MeshGeometry& geometry, PlateMesh& plate);

}  // namespace fastjoint::stage1
