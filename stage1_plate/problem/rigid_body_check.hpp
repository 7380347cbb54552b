// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/mesh/plate_mesh.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// Throws NumericalError if the plate, or a part of it, could move as a rigid body while all externals and discs are
/// held; the message says how (docs/theory.md, section 4.6). The factor alone would not show it.
void check_held(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns);

/// Whether nothing can move as a rigid body while the scene's loads act: externals and discs of given force follow.
/// @param scene A scene that has loads, with springs on the parts of the rims that bear.
[[nodiscard]] bool is_held_under_loads(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns);

}  // namespace fastjoint::stage1
