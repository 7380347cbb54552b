// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage2_extract/field/field_state.hpp"

namespace fastjoint::stage2 {

/// The state of the plate in a solved joint, the RESULT.h5 that the request's spec names. The sheet is that which the
/// request names, else the only one whose cases have the plate's names; the increment that of the request, else the
/// last. Throws InputError, FileError.
[[nodiscard]] FieldState joint_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

}  // namespace fastjoint::stage2
