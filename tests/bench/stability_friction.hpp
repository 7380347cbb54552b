// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fastjoint::bench {

/// Prints, for coefficients of friction from 0 to 2, how many of n random joints in contact are solved from no load and
/// from far away, and how many have other forces from there: where friction fails (docs/theory.md, section 6.5).
/// @return Whether every joint was solved from no load.
[[nodiscard]] bool chart_friction(int n);

}  // namespace fastjoint::bench
