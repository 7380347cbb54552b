// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// Takes the user's mesh as it is, without rims. Throws InputError if it is not conforming: an edge of more than two
/// elements, a node that hangs on an edge, an arc that no element has, a node that nothing uses, or if an edge that it
/// names will not do: named_edges.hpp.
[[nodiscard]] PlateMesh mesh_explicit(const PlateScene& scene, const MeshGeometry& geometry);

}  // namespace fastjoint::stage1
