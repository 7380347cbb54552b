// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/program/timings.hpp"
#include "stage2_extract/field/field_state.hpp"

namespace fastjoint::stage2 {

/// Throws InputError if options are given that need others, or if an output would replace the joint's result.
/// @param wanted  Whether a field is asked for at all.
/// @param timings Path of --timings, or empty.
void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings);

/// Writes the field that the request describes, whole or not at all, and says in two lines what it is. Goes on from the
/// phase "read" to "extract" and "write".
/// @param file Name of the plate's file, for messages.
/// Throws InputError if the request fits neither plate nor joint, FileError.
[[nodiscard]] std::string write_field(const std::string& output, const formats::PlateSolution& plate,
                                      const std::string& file, const FieldRequest& request, program::Timings& timings);

}  // namespace fastjoint::stage2
