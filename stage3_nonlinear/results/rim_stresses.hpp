// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// The loaded rim of a hole; null without one.
[[nodiscard]] const LoadedRim* loaded_rim(const PlateState& state, const std::string& hole);

/// Sets the points on the rims of a plate, one degree apart, at which there are stresses.
/// @param state Any of the plate, with its loaded rims; null for no points.
void set_points(const PlateState* state, formats::HoleList& holes);

/// Stresses of the sheet at those points.
[[nodiscard]] PlateGroup rim_stresses(const formats::HoleList& points);

}  // namespace fastjoint::stage3
