// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// The path as RESULT.h5 holds it, one state per step; the header is left to the caller.
[[nodiscard]] formats::JointResult joint_result(const JointModel& joint, const LoadPath& path,
                                                const std::vector<JointState>& states);

/// The derivatives of the bearing forces at every step of the path, as RESULT.h5 holds them.
[[nodiscard]] formats::SensitivityHistory sensitivity_history(const JointModel& joint, const JointEquations& equations,
                                                              const LoadPath& path);

/// One line per increment and shear plane under a line of names; all digits, RFC 4180. What a plate's matrices do not
/// tell, stresses and bypass loads, is left empty.
[[nodiscard]] std::string csv(const JointModel& joint, const formats::JointResult& result);

}  // namespace fastjoint::stage3
