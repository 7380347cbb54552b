// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>

#include "common/program/program.hpp"

namespace fastjoint::stage3 {

inline constexpr const char* program_name = "stage3_nonlinear";

/// Solves a joint for the samples of a study (--study), or writes the joint of one of them (--sample).
void run_study(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings);

}  // namespace fastjoint::stage3
