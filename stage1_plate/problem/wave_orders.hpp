// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

inline constexpr int min_order = 4;
/// Highest order of the waves of contact, most of which have a closed form.
inline constexpr int default_harmonics = 64;

/// Highest order of waves that elements of degree p resolve with this number of sides around a whole hole.
[[nodiscard]] int resolved_order(int p, double n_sides);

/// Highest order of the waves around each hole that the elements must include: fields of higher order reflected by
/// edges, other holes, point springs and steps of thickness or material are negligible, and the closed form holds. A
/// value in the scene takes precedence (docs/theory.md, section 11.3).
[[nodiscard]] std::vector<int> needed_orders(const PlateScene& scene, const PlateMesh& plate);

/// Holes whose order is given in the scene and lower than they need: a line for each.
[[nodiscard]] std::vector<std::string> few_waves(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
