// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// A spring between a coefficient of a vertex, by its target, and a controlled displacement.
struct PointTie {
  int vertex, target, controlled;
  double stiffness;  ///< force / length
};

/// Springs between vertices of the mesh and discs of their own, section 3.1 of the paper: the displacement of the
/// vertex, and with it the springs' load, does not converge. Throws InputError where a support holds the vertex.
[[nodiscard]] std::vector<PointTie> tie_points(const PlateScene& scene, const PlateMesh& plate,
                                               const Unknowns& unknowns);

}  // namespace fastjoint::stage1
