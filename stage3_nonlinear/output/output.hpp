// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/output/warning_list.hpp"
#include "stage3_nonlinear/results/crack_errors.hpp"
#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {

/// Which stresses besides the peaks at the rims RESULT.h5 has.
struct MoreStresses {
  bool all_around = false;           ///< around all holes, one degree apart
  std::optional<double> distance{};  ///< peaks, and with `all_around` stresses, at this distance from the rims, length
};

/// The contents of RESULT.h5 for a path, one state per step; the header is left to the caller.
/// @param errors Of the cracks of each plate.
[[nodiscard]] formats::JointResult joint_result(const JointModel& joint, const JointEquations& equations,
                                                const LoadPath& path, const Increments& increments,
                                                const MoreStresses& wanted, const std::vector<CrackErrors>& errors);

/// The contents of RESULT.h5 for the derivatives of the bearing forces at every step of the path, and of the peaks at
/// the last.
[[nodiscard]] formats::SensitivityHistory sensitivity_history(const JointModel& joint, const Increments& increments);

/// One line per increment and shear plane after a line of names; all digits, RFC 4180. Stresses and bypass loads are
/// empty if the plate's matrices do not have them.
[[nodiscard]] std::string csv(const JointModel& joint, const formats::JointResult& result);

/// Its first lines: the joint, its laws, and how well the stiffness of its plates is known.
[[nodiscard]] std::string summary_title(const JointScene& scene, const JointModel& joint);

/// The summary on stdout: the fasteners, the plates and the equilibrium of each increment.
///
/// @param states       One per step of the path, as `result`.
/// @param all_stresses Print those of every increment, not only those of the last.
[[nodiscard]] std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                                  const std::vector<JointState>& states, const formats::JointResult& result,
                                  bool all_stresses);

/// Warnings about the solution, one sentence each: bearing of sheets counted twice, laws used beyond their last point,
/// a mechanism within the gaps, other solutions, self-locking.
[[nodiscard]] std::vector<program::Warning> warnings(const JointModel& joint, const JointEquations& equations,
                                                     const LoadPath& path);

/// Warnings about unlikely numbers, one sentence each: friction above 1, a gap or |delta| above a radius, distances
/// between the centres of a fastener's holes (with three or more fasteners between two plates relative to the median,
/// since plates may have coordinates of their own), diameters that differ by more than 5 %, a formula for other sheets
/// or another number of them, F above d t E. Holes without data in MATRICES.h5 are not checked.
[[nodiscard]] std::vector<program::Warning> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                                const Parameters& parameters, const LoadPath& path);

/// Warnings about rims, one sentence of each kind with the hole and the increment where it is worst.
[[nodiscard]] std::vector<program::Warning> rim_warnings(const JointModel& joint, const Parameters& parameters,
                                                         const std::vector<JointState>& states);

/// Warning about the crack whose tip closes most: its faces overlap in the model.
[[nodiscard]] std::vector<program::Warning> crack_warnings(const JointModel& joint,
                                                           const std::vector<JointState>& states,
                                                           const std::vector<CrackErrors>& errors);

/// Warning about the first increment whose secondary bending is not known.
[[nodiscard]] std::vector<program::Warning> bending_warnings(const JointModel& joint,
                                                             const std::vector<JointState>& states);

/// Warning about the holes around which the sheet ends, or another hole begins, before a distance.
[[nodiscard]] std::vector<program::Warning> distance_warnings(const JointModel& joint, double distance);

/// Message for a path with a failure: why and where it ended, and what to check.
/// @param output File with the increments before.
[[nodiscard]] std::string failure_message(const JointScene& scene, const CaseScene& its, const JointModel& joint,
                                          const LoadPath& path, const std::string& output);

/// "increment 2 (load factor 0.5)"
[[nodiscard]] std::string increment_text(const LoadPath& path, const PathStep& step);
/// Names of shear planes, separated by commas.
[[nodiscard]] std::string names(const JointModel& joint, const std::vector<Index>& planes);

/// Warns of the first increment that unloads planes after slip or yield, or on a curved law, and of the first at which
/// the force of a fastener with friction falls or turns.
void warn_of_unloading(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                       WarningList& list);

}  // namespace fastjoint::stage3
