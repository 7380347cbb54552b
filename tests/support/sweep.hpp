// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>

namespace fastjoint::test {

/// Number of random scenes out of n, or of what they must show at least: all in a sweep, which the environment variable
/// FASTJOINT_SWEEP asks for and scripts/check/check_all runs, a quarter in every other run.
[[nodiscard]] inline int scenes(int n) { return std::getenv("FASTJOINT_SWEEP") != nullptr ? n : (n + 3) / 4; }

}  // namespace fastjoint::test
