// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Contact at the rims of a plate with compression-only springs: the arcs on which disc and rim touch, and pressures.
[[nodiscard]] PlateGroup contact_quantities(const PlateModel& plate);

/// The rims of contact of a plate before it is loaded.
[[nodiscard]] formats::RimsAtNoLoad rims_at_no_load(const JointModel& joint, const JointEquations& equations,
                                                    const LoadPath& path, Index plate);

}  // namespace fastjoint::stage3
