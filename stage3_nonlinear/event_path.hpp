// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/load_path.hpp"

namespace fastjoint::stage3 {

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// mark of its law (contact_event.hpp), and one at 1.
///
/// On an exact path these are its corners. Else the load factor itself becomes an unknown while the fastener stays on
/// its mark: Newton's method from where the solved states before and after suggest. The first that is found is taken,
/// if nothing else has happened before; where that is not sure, or the curves between two states point beyond a mark,
/// the interval is halved.
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

}  // namespace fastjoint::stage3
