// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage2_extract/field/field_state.hpp"

namespace fastjoint::stage2 {

/// Whether the text starts as a case does: "external:", "disc:", "friction:" or "traction:".
[[nodiscard]] bool starts_as_case(const std::string& spec);

/// What a message says a spec may be, besides "loads".
[[nodiscard]] std::string case_sum_allowed(const formats::PlateSolution& plate);

/// Cases with commas between them, each with "=AMOUNT" or of amount 1: "external:P=0.01,disc:1:x". Ids may hold commas,
/// colons and equals signs: where one case's name begins another's, the longer one is meant.
/// Throws InputError that lists the plate's cases.
[[nodiscard]] FieldState case_sum(const formats::PlateSolution& plate, const std::string& spec);

}  // namespace fastjoint::stage2
