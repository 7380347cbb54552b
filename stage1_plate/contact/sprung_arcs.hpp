// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/rim/rim.hpp"

namespace fastjoint::stage1 {

/// Arcs of one rim, radians counter-clockwise; each starts in [-pi, pi), ascending, and none touches another.
using Arcs = std::vector<rim::AngleRange>;

/// Joins the pieces that touch, across +-pi too; a whole circle is one arc from -pi to pi. Pieces do not overlap.
[[nodiscard]] Arcs joined(std::vector<rim::AngleRange> pieces);

/// How far the farthest end has moved, radians; infinite if the number of arcs differs.
[[nodiscard]] double largest_move(const Arcs& before, const Arcs& after);

}  // namespace fastjoint::stage1
