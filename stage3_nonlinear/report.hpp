// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/joint_scene.hpp"
#include "stage3_nonlinear/load_path.hpp"

namespace fastjoint::stage3 {

/// What the solution shows that the user should know, one sentence each: bearing of sheets counted twice, laws used
/// beyond their last point, a mechanism within the gaps, other solutions, self-locking.
[[nodiscard]] std::vector<std::string> warnings(const JointModel& joint, const JointEquations& equations,
                                                const LoadPath& path);

/// Why the path ended, where, and what to check.
///
/// @param n_increments That were asked for.
/// @param output       File that holds the increments before.
[[nodiscard]] std::string failure_message(const JointScene& scene, const JointModel& joint, const PathFailure& failure,
                                          std::size_t n_increments, const std::string& output);

}  // namespace fastjoint::stage3
