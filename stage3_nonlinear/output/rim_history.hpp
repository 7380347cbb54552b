// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// How many sections across x the plate has beside the hole.
[[nodiscard]] int n_sections(const formats::PlateStresses& stresses, const std::string& hole);

/// What the holes of one plate showed, one row per step.
[[nodiscard]] formats::RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states,
                                              std::size_t at);

/// Adds the columns of the CSV for one side of a shear plane ("first" or "second").
void add_rim_csv_heads(const std::string& end, const Units& units, std::vector<std::string>& heads);

/// Their values for a hole at a step.
[[nodiscard]] std::string rim_csv_fields(const formats::RimHistory& rims, const std::string& hole, Eigen::Index step);

}  // namespace fastjoint::stage3
