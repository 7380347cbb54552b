// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Unit total force on every external that is not rigid: uniform traction on an edge, cosine pressure on an open hole.
/// Sets T_f, T_c.
void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);

}  // namespace fastjoint::stage1
