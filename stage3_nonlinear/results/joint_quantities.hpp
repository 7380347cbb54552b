// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Forces and displacements of the shear planes.
[[nodiscard]] std::vector<JointGroup> plane_quantities(const JointModel& joint);
/// What the laws of the shear planes remember; nothing if no law does.
[[nodiscard]] std::vector<JointGroup> memory_quantities(const JointModel& joint, const JointEquations& equations);
/// All quantities of a plate that every run and every study has: of its holes, rims of contact, externals, discs,
/// tractions, crack tips and rows.
[[nodiscard]] std::vector<PlateGroup> plate_quantities(const PlateModel& plate);
/// The things of a plate that quantities are of, without columns.
[[nodiscard]] formats::PlateHistory things_of(const PlateModel& plate);

}  // namespace fastjoint::stage3
