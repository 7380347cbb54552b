// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// What secondary bending adds by bending_factors, a line for each sheet of a joint of two sheets alone whose fasteners
/// are in single shear and pull both; empty for other joints and without stresses.
[[nodiscard]] std::string secondary_bending(const JointModel& joint, const JointState& state);

}  // namespace fastjoint::stage3
