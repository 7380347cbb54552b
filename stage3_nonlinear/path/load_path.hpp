// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/path/path_result.hpp"

namespace fastjoint::stage3 {

/// Follows the load factors, each increment from the last. If all fasteners are linear springs without gap, linear
/// solves do it; if all are linear between corners, their exact path as far as it goes, unless the options are against
/// it. Else the chosen solver in the contact coordinates from the last state, then damped Newton, then both in half
/// steps. Only what cannot be reached so is tried from the first guesses, by the same, with friction also by turns of
/// damped Newton under the friction of the turn before, at last in half steps.
///
/// The first increment begins with the first guesses, unless the solution may be one of several: then at no load. There
/// each step must also agree with two half steps; one that does not, however short, is a jump.
[[nodiscard]] LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors,
                              const PathOptions& options);

/// The same, by the nonlinear solvers even if linear solves or an exact path would do.
[[nodiscard]] LoadPath follow_nonlinear(const JointEquations& equations, const std::vector<double>& load_factors,
                                        const PathOptions& options);

/// Least load factor that is searched for events: what happens below is there from the start.
inline constexpr double first_load_factor = 1e-6;

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// corner of its law (contact_event.hpp), and one at 1.
///
/// These are the corners of an exact path. On any other path the load factor becomes an unknown of Newton's method
/// while the fastener stays on its corner, between solved states whose interval is halved where the order of events is
/// in doubt (docs/theory.md, section 8.7).
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

}  // namespace fastjoint::stage3
