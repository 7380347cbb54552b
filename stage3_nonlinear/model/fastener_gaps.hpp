// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Radial gap between a fastener and its hole number `at`, length; infinite if the hole's diameter is not known.
[[nodiscard]] double gap_of(const FastenerScene& fastener, Index at, const PlateModel& plate);

/// Refuses a gap in a hole whose springs also pull.
void check_gap(const FastenerScene& fastener, const std::string& hole, const PlateModel& plate, double gap);

/// Radial gaps that let neighbouring sheets move as far as the clearances of a fastener's shear planes do: the gaps of
/// the two holes of a plane add up to its clearance, and the ground and holes that are not in contact have none.
///
/// @param clearance (n) of the shear planes, length.
/// @param in_contact (h) true of each hole whose springs push but do not pull; h = n, the last plane being to the
/// ground, or n + 1.
/// @return (h) none of them negative, the middle of the range if several are right; empty if there are none such.
[[nodiscard]] std::vector<double> equal_gaps(const std::vector<double>& clearance, const std::vector<bool>& in_contact);

/// Refuses a clearance of a law next to a hole whose springs push but do not pull, where the gap is a number of each
/// hole. Throws InputError with the gaps that mean the same.
void check_clearance(const JointModel& model, const FastenerScene& scene, const FastenerModel& fastener);

}  // namespace fastjoint::stage3
