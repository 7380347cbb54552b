// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/study_result.hpp"

namespace fastjoint::stage3 {

/// What a study prints: its samples, and a table of each kind of number.
[[nodiscard]] std::string study_summary(const formats::StudyResult& result, const std::string& failures);

}  // namespace fastjoint::stage3
