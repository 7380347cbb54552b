// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// The summary on stdout of several load cases: a line for each, and the envelope of forces, peaks and crack tips.
[[nodiscard]] std::string case_summary(const JointScene& scene, const JointModel& joint,
                                       const formats::JointResult& result);

}  // namespace fastjoint::stage3
