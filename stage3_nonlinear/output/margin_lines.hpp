// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// The smallest margin of each check, then the smallest of the others, one line each, with formula and numbers; empty
/// without checks.
[[nodiscard]] std::string margin_lines(const JointScene& scene, const formats::JointResult& result);

/// One line for each margin after a line of names; all digits, RFC 4180.
[[nodiscard]] std::string margins_csv(const formats::JointResult& result);

}  // namespace fastjoint::stage3
