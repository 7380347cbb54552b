// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/equilibrium.hpp"

namespace fastjoint::stage3 {

/// What the holes of one plate showed, one row per step.
[[nodiscard]] formats::RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states,
                                              std::size_t at);

/// Adds the columns of the CSV for one side of a shear plane ("first" or "second").
void add_rim_csv_heads(const std::string& end, const formats::Units& units, std::vector<std::string>& heads);

/// Their values for a hole at a step.
[[nodiscard]] std::string rim_csv_fields(const formats::RimHistory& rims, const std::string& hole, Eigen::Index step);

/// One sentence for each kind of doubt about rims, naming the hole and the increment where it is largest.
[[nodiscard]] std::vector<std::string> rim_warnings(const JointModel& joint, const std::vector<JointState>& states);

/// The table of the summary: every hole of every plate at one increment. Empty if no plate has stresses.
[[nodiscard]] std::string rim_table(const JointModel& joint, const JointState& state);

}  // namespace fastjoint::stage3
