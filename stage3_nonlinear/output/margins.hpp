// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Margins of the joint's checks: for each check and each hole or fastener the smallest over all increments of all
/// cases, margin = allowable / (FS FF applied) - 1; the smallest first. Infinite where nothing is applied.
///
/// Throws InputError if a check names what is not there, or needs stresses or an edge distance that are not known.
/// @param result Of no increments to check the scene alone.
/// @param left_out Gets a warning for each check of the holes that it cannot be made for.
[[nodiscard]] formats::MarginTable margins(const JointScene& scene, const JointModel& joint,
                                           const formats::JointResult& result, std::vector<program::Warning>& left_out);

/// Warning of holes that are checked for bearing or shear-out nearer to an edge than 1.5 diameters.
[[nodiscard]] std::vector<program::Warning> edge_warnings(const JointScene& scene, const formats::MarginTable& table);

/// The smallest margin of each check, then the smallest of the others, one line each, with formula and numbers; empty
/// without checks.
[[nodiscard]] std::string margin_lines(const JointScene& scene, const formats::JointResult& result);

/// One line for each margin after a line of names; all digits, RFC 4180.
[[nodiscard]] std::string margins_csv(const formats::JointResult& result);

}  // namespace fastjoint::stage3
