// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/equilibrium.hpp"
#include "stage3_nonlinear/joint_scene.hpp"

namespace fastjoint::stage3 {

/// The summary on stdout: per increment the fasteners, the plates and how well all of it balances.
///
/// @param states One per step of the path.
[[nodiscard]] std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                                  const std::vector<JointState>& states);

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
