// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

inline constexpr int lowest_order = 4;
/// Highest order of the waves of contact, most of which a closed form holds for.
inline constexpr int default_harmonics = 64;

/// Highest order of waves that elements of degree p follow with so many sides around a whole hole.
[[nodiscard]] int followed_order(int p, double sides);

/// Order of the waves around each hole beyond which what edges, other holes, springs at points and steps of thickness
/// or material send back is left to the closed form; or what the scene says (docs/theory.md, section 11.3).
[[nodiscard]] std::vector<int> wanted_orders(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
