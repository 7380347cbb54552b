// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// The table of the summary: every hole of every plate at one increment. Empty if no plate has stresses.
[[nodiscard]] std::string rim_table(const JointModel& joint, const JointState& state);

}  // namespace fastjoint::stage3
