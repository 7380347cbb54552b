// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/path/path_result.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Warnings that the solution gives cause for, one sentence each: bearing of sheets counted twice, laws used
/// beyond their last point, a mechanism within the gaps, other solutions, self-locking.
[[nodiscard]] std::vector<std::string> warnings(const JointModel& joint, const JointEquations& equations,
                                                const LoadPath& path);

/// Numbers that hardly any joint has, one sentence each: friction above 1, a gap or |delta| above a radius, centres of
/// a fastener's holes apart (of three and more fasteners between two plates: from the median, since plates may be drawn
/// in coordinates of their own), a formula for other sheets, F above d t E. Numbers that MATRICES.h5 does not tell of a
/// hole are not compared.
[[nodiscard]] std::vector<std::string> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                           const LoadPath& path);

/// One sentence for each kind of doubt about rims, naming the hole and the increment where it is largest.
[[nodiscard]] std::vector<std::string> rim_warnings(const JointModel& joint, const std::vector<JointState>& states);

/// Message that says why the path ended, where, and what to check.
///
/// @param n_increments Number that was asked for.
/// @param output       File that holds the increments before.
[[nodiscard]] std::string failure_message(const JointScene& scene, const JointModel& joint, const PathFailure& failure,
                                          std::size_t n_increments, const std::string& output);

}  // namespace fastjoint::stage3
