// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace fastjoint::bench {

/// What was found at joints with laws that fall.
struct Falling {
  int joints = 0;
  int solved = 0;   ///< by the program
  int several = 0;  ///< with more than one solution, by many starts
  int warned = 0;   ///< of these, those that the program warns of
  std::vector<std::string> broken;
};

/// Joints of 1 to 3 fasteners: whatever the program returns must balance to the tolerance with no fastener failed,
/// where a hundred random starts find a solution it must find one, and where they find two it must warn, of all such
/// laws or at the solution it returns.
[[nodiscard]] Falling check_falling(int n, double tolerance);

}  // namespace fastjoint::bench
