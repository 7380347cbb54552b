// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Lines of the secondary bending of a state: of each sheet that bends its largest k_b and its largest peak with
/// bending; empty without it.
[[nodiscard]] std::string secondary_bending(const JointModel& joint, const JointState& state);

}  // namespace fastjoint::stage3
