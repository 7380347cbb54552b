// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/strength/checked_items.hpp"

namespace fastjoint::stage3 {

/// Margins of the joint's checks: of each item the smallest over all increments of the check's cases; the smallest
/// first.
/// @param left_out Gets the items whose margin is not known, at all increments or at some.
[[nodiscard]] std::vector<formats::Margin> margins(const std::vector<CheckedItem>& items,
                                                   const formats::JointResult& result, LeftOut& left_out);

/// Warning of holes that are checked for bearing or shear-out nearer to an edge than 1.5 diameters.
[[nodiscard]] std::vector<program::Warning> edge_warnings(const JointScene& scene,
                                                          const std::vector<formats::Margin>& margins);

}  // namespace fastjoint::stage3
