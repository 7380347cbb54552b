// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/results/crack_errors.hpp"

namespace fastjoint::stage3 {

/// Stress intensity factors of a plate's tips, and their errors.
[[nodiscard]] PlateGroup crack_quantities(const PlateModel& plate);
[[nodiscard]] PlateGroup crack_error_quantities(const PlateModel& plate, const CrackErrors& errors);

}  // namespace fastjoint::stage3
