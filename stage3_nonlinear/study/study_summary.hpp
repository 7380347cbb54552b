// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/study.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

/// The summary of a study: its samples, and a table for each kind of number.
[[nodiscard]] std::string study_summary(const formats::StudyResult& result, const StudyScene& scene,
                                        const std::string& failures);

}  // namespace fastjoint::stage3
