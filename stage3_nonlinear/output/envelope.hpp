// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Largest and smallest values over all increments of all load cases: of shear planes, of holes with stresses or
/// contact, of externals and of crack tips. Values that are not known are left out.
[[nodiscard]] std::vector<formats::EnvelopeTable> envelope(const JointModel& joint, const formats::JointResult& result);

/// One line for each quantity and what it is of, after a line of names; all digits, RFC 4180.
[[nodiscard]] std::string envelope_csv(const formats::JointResult& result);

/// "increment 2 of case "a"": a row of a result; without the case if the joint has none.
[[nodiscard]] std::string increment_of(const formats::JointResult& result, Eigen::Index row);
/// Number of a row among the increments of its case, from 1.
[[nodiscard]] Eigen::Index increment_number(const formats::JointResult& result, Eigen::Index row);

}  // namespace fastjoint::stage3
