// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/problem/assembler.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Normal springs between every rim and its rigid disc, equation (6), as far as controlled displacements
/// feel them: -int k t (u.n)(e.n) ds between plate and disc, int k t (e.n)(e'.n) ds of the disc, and what a rim that
/// ends on a rigid external has of int k t (v.n)(u.n) ds; sums over nodes for links.
/// Throws InputError for an arc that the rim of the model does not have.
void add_springs(const PlateScene& scene, const PlateProblem& problem, Assembler& assembler);

/// Unit friction cases of every disc of a hole, direction inner, bearing side + then -: tangential traction cos(theta)
/// on the bearing half of the rim, dragging the plate along the bearing direction. Sets L_f, L_c.
void add_friction_loads(PlateProblem& problem);

}  // namespace fastjoint::stage1
