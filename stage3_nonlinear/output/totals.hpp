// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"

namespace fastjoint::stage3 {

/// Resultants of every sheet, forces of its rows of holes and over the sections beside them, and displacements and
/// loads of its externals at every increment: one number in a line, after a line of names; all digits, RFC 4180. What
/// is not known has no line.
[[nodiscard]] std::string totals_csv(const formats::JointResult& result);

/// Table of the rows of sheets with more than one along the axis on which rows carry most, at a row of the result;
/// empty if there are none.
[[nodiscard]] std::string row_table(const formats::JointResult& result, const Units& units, Eigen::Index step);
/// Table of the loads and displacements of all externals at a row of the result; empty if there are none.
[[nodiscard]] std::string external_table(const formats::JointResult& result, const Units& units, Eigen::Index step);

}  // namespace fastjoint::stage3
