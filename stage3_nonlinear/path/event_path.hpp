// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/path/path_result.hpp"

namespace fastjoint::stage3 {

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// mark of its law (contact_event.hpp), and one at 1.
///
/// On an exact path these are its corners. Otherwise the load factor becomes an unknown of Newton's method while the
/// fastener stays on its mark, between solved states whose interval is halved where the order of events is in doubt
/// (docs/theory.md, section 8.7).
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

}  // namespace fastjoint::stage3
