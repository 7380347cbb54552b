// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>

#include "common/program/program.hpp"

namespace fastjoint::stage3 {

/// The whole stage: reads the joint and its matrices, solves, writes RESULT.h5 and the CSV, prints the summary to `out`
/// and warnings to `log`. Its phases are "read", "solve", "write".
///
/// If an increment does not converge, the files hold those before it, marked incomplete, and IncompleteResult says why.
void run(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings);

}  // namespace fastjoint::stage3
