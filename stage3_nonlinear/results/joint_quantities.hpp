// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Forces and displacements of the shear planes.
[[nodiscard]] std::vector<JointGroup> plane_quantities(const JointModel& joint);
/// What the laws of the shear planes remember; nothing if no law does.
[[nodiscard]] std::vector<JointGroup> memory_quantities(const JointModel& joint, const JointEquations& equations);
/// Displacements of a plate's discs and externals, the forces on them, and their resultants.
[[nodiscard]] std::vector<PlateGroup> displacement_quantities(const PlateModel& plate);

}  // namespace fastjoint::stage3
