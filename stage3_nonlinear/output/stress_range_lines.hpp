// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"

namespace fastjoint::stage3 {

/// Lines of the summary for the largest stress ranges, of one case for the largest alone; empty without any.
[[nodiscard]] std::string stress_range_lines(const formats::JointResult& result);

}  // namespace fastjoint::stage3
