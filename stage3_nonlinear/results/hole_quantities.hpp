// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Loads and stresses of the holes of a plate; of no holes if its matrices have no stresses at the joint's degree.
[[nodiscard]] PlateGroup hole_quantities(const PlateModel& plate);

}  // namespace fastjoint::stage3
