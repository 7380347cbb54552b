// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/path/path_result.hpp"

namespace fastjoint::stage3 {

/// The derivatives of the bearing forces at every step of the path, as RESULT.h5 holds them.
[[nodiscard]] formats::SensitivityHistory sensitivity_history(const JointModel& joint, const JointEquations& equations,
                                                              const LoadPath& path);

}  // namespace fastjoint::stage3
