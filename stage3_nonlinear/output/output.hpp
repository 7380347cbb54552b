// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {

/// The path as RESULT.h5 holds it, one state per step; the header is left to the caller.
/// @param with_rim_stresses Also the stresses around all holes, one degree apart.
[[nodiscard]] formats::JointResult joint_result(const JointModel& joint, const JointEquations& equations,
                                                const LoadPath& path, const Increments& increments,
                                                bool with_rim_stresses);

/// The derivatives of the bearing forces at every step of the path, and of the peaks at the last, as RESULT.h5 holds
/// them.
[[nodiscard]] formats::SensitivityHistory sensitivity_history(const JointModel& joint, const LoadPath& path,
                                                              const Increments& increments);

/// One line per increment and shear plane under a line of names; all digits, RFC 4180. What a plate's matrices do not
/// tell, stresses and bypass loads, is left empty.
[[nodiscard]] std::string csv(const JointModel& joint, const formats::JointResult& result);

/// The summary on stdout: per increment the fasteners, the plates and how well all of it balances.
///
/// @param states       One per step of the path, as `result`.
/// @param all_stresses Print those of every increment, not of the last alone.
[[nodiscard]] std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                                  const std::vector<JointState>& states, const formats::JointResult& result,
                                  bool all_stresses);

/// Warnings that the solution gives cause for, one sentence each: bearing of sheets counted twice, laws used
/// beyond their last point, a mechanism within the gaps, other solutions, self-locking.
[[nodiscard]] std::vector<program::Warning> warnings(const JointModel& joint, const JointEquations& equations,
                                                     const LoadPath& path);

/// Numbers that hardly any joint has, one sentence each: friction above 1, a gap or |delta| above a radius, centres of
/// a fastener's holes apart (of three and more fasteners between two plates: from the median, since plates may be drawn
/// in coordinates of their own), diameters that contradict each other, a formula for other sheets or another number of
/// them, F above d t E. Numbers that MATRICES.h5 does not tell of a
/// hole are not compared.
[[nodiscard]] std::vector<program::Warning> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                                const LoadPath& path);

/// Diameters that contradict those of the sheets' holes or each other by more than 5 %, whatever the law:
/// hole_diameter, and those of the two holes of a shear plane, less the gaps in them.
[[nodiscard]] std::vector<program::Warning> unlike_diameters(const JointScene& scene, const JointModel& joint);

/// One sentence for each kind of doubt about rims, naming the hole and the increment where it is largest.
[[nodiscard]] std::vector<program::Warning> rim_warnings(const JointModel& joint,
                                                         const std::vector<JointState>& states);

/// Message that says why a path with a failure ended, where, and what to check.
/// @param output File that holds the increments before.
[[nodiscard]] std::string failure_message(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                                          const std::string& output);

/// "increment 2 (load factor 0.5)"
[[nodiscard]] std::string increment_text(const LoadPath& path, const PathStep& step);
/// Names of shear planes, parted by commas.
[[nodiscard]] std::string names(const JointModel& joint, const std::vector<Index>& planes);

/// Names the first increment at which planes are unloaded that have slipped, yielded or been on a curved law.
void warn_of_unloading(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                       std::vector<program::Warning>& result);
/// Names the first increment at which the force of a fastener with friction falls or turns.
void warn_of_turning_friction(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                              std::vector<program::Warning>& result);

/// The sentence of a warning and the size of its doubt, > 0.
using Doubt = std::pair<double, std::string>;

/// Appends the worst warning of one kind about several fasteners or holes, with the number of the others.
void add_worst(std::vector<program::Warning>& warnings, const char* code, const std::vector<Doubt>& kind);

}  // namespace fastjoint::stage3
