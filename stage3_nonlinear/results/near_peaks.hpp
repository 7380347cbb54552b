// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Distance from the rim of each hole of a plate to what is nearest to it: the outline of the sheet, but for lines of
/// symmetry through its centre, or another hole; infinite where neither is known, (r), length.
[[nodiscard]] VectorXd room_around(const PlateModel& plate);

/// Stresses at a distance from the rims of a plate at every increment. A hole without a closed form or without room has
/// peaks of 0 with an infinite error, and infinite stresses.
/// @param around Points of which the stresses are wanted; null for the peaks alone.
[[nodiscard]] formats::NearStresses near_stresses(const PlateModel& plate, const std::vector<JointState>& states,
                                                  Index at, double distance, const formats::RimStresses* around);

}  // namespace fastjoint::stage3
