// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Radial gap between a fastener and its hole number `at`, length; infinite if the hole's diameter is not known.
[[nodiscard]] double gap_of(const FastenerScene& fastener, Index at, const PlateModel& plate);

/// Refuses a gap in a hole whose springs act in tension too.
void check_gap(const FastenerScene& fastener, const std::string& hole, const PlateModel& plate, double gap);

/// Radial gaps that are equivalent to the clearances of a fastener's shear planes: the gaps of the two holes of a plane
/// add up to its clearance, and the ground and holes that are not in contact have none.
///
/// @param clearance (n) of the shear planes, length.
/// @param in_contact (h) true for each hole with compression-only springs; h = n if the last plane is to the ground,
/// else n + 1.
/// @return (h) none of them negative, the middle of the range if several are right; empty if none are.
[[nodiscard]] std::vector<double> equal_gaps(const std::vector<double>& clearance, const std::vector<bool>& in_contact);

/// Refuses a clearance of a law next to a hole with compression-only springs, where each hole has a gap instead.
/// Throws InputError with the equivalent gaps.
void check_clearance(const JointModel& model, const FastenerScene& scene, const FastenerModel& fastener);

}  // namespace fastjoint::stage3
