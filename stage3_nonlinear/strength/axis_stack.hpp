// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/strength/sheet_stack.hpp"

namespace fastjoint::stage3 {

/// The sheets of a joint along one axis, in the order of its plates.
struct AxisStack {
  Index direction;                   ///< of the joint's discs
  int axis;                          ///< 0 x, 1 y
  std::vector<Index> first_row;      ///< of each plate, among its disc_rows; -1 without rows along the axis
  std::vector<Index> link_of_plane;  ///< (n) -1 where the discs do not move along the axis
  SheetStack stack;
};

/// The stacks along all axes of a joint; none of one without secondary bending. Throws InputError if fasteners
/// contradict each other in the order of the sheets.
[[nodiscard]] std::vector<AxisStack> axis_stacks(const JointModel& joint, const JointScene& scene);

}  // namespace fastjoint::stage3
