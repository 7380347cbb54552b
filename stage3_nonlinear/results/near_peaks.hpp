// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Distance from the rim of each hole of a plate to what is nearest to it: the outline of the sheet, but for lines of
/// symmetry through its centre, or another hole; infinite where neither is known, (r), length.
[[nodiscard]] VectorXd room_around(const PlateModel& plate);

/// Highest hoop stresses at a distance from the rims of a plate; NaN with an infinite error at a hole without a closed
/// form or without room.
[[nodiscard]] PlateGroup near_peaks(const PlateModel& plate, double distance);

/// Stresses at that distance outwards from points on the rims; infinite at such holes.
[[nodiscard]] PlateGroup near_stresses(const PlateModel& plate, double distance, const formats::HoleList& points);

}  // namespace fastjoint::stage3
