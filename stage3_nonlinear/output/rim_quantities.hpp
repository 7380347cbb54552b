// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Quantities of the holes of one plate, one row per step.
[[nodiscard]] formats::RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states,
                                              std::size_t at);

/// Heads of the CSV's columns for one side of a shear plane, "first" or "second".
[[nodiscard]] std::vector<std::string> rim_csv_heads(const std::string& side, const Units& units);

/// Values of these columns for a hole at a step; empty if not known.
[[nodiscard]] std::vector<std::string> rim_csv_fields(const formats::RimHistory& rims, const std::string& hole,
                                                      Eigen::Index step);

/// The table of the summary: every hole of every plate at one increment. Empty if no plate has stresses.
[[nodiscard]] std::string rim_table(const JointModel& joint, const JointState& state);

}  // namespace fastjoint::stage3
