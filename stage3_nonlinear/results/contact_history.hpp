// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

namespace fastjoint::stage3 {

/// Contact at the rims of every plate at all steps, plate after plate.
[[nodiscard]] std::vector<formats::ContactHistory> contact_histories(const JointModel& joint,
                                                                     const JointEquations& equations,
                                                                     const LoadPath& path);

}  // namespace fastjoint::stage3
