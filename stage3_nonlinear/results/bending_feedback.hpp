// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/strength/axis_stack.hpp"

namespace fastjoint::stage3 {

using StackShapes = std::vector<StackShape>;  ///< of each axis

/// Displacement of a sheet along an axis by the shortening of its beam at each of its nodes, about its supports,
/// length.
[[nodiscard]] VectorXd shortened(const PlateModel& plate, int axis, const StackSheet& sheet, const VectorXd& integral);
/// Node of a sheet at a rigid external.
[[nodiscard]] Index node_at(const PlateModel& plate, Index external, const StackSheet& sheet);

/// How secondary bending acts back on the joint in the plane: slopes and shortening displace the free sheets, by one
/// amount at all fasteners of a link of a stack, and one at each external with a given displacement.
class BendingFeedback {
 public:
  /// @param axes, equations Outlive this.
  BendingFeedback(const JointModel& joint, const std::vector<AxisStack>& axes, const JointEquations& equations);

  /// The m amounts z by the shapes of the stacks, length.
  [[nodiscard]] VectorXd amounts(const StackShapes& shapes) const;
  /// The equations with the free sheets displaced by these.
  [[nodiscard]] JointEquations displaced(const VectorXd& z) const;
  /// Derivatives of the forces of a solved point by each amount: bearing forces and those on externals, as states.
  [[nodiscard]] std::vector<JointState> responses(const SolvedPoint& point) const;

 private:
  struct Load {
    Index of;                     ///< among loads_of
    Index plate, external, axis;  ///< the last among axes
  };

  const JointModel& joint_;
  const std::vector<AxisStack>& axes_;
  const JointEquations& equations_;
  Index m_ = 0;
  std::vector<Index> first_;  ///< first amount of the links of each axis; those of the loads follow
  std::vector<Load> loads_;   ///< externals with a given displacement
};

}  // namespace fastjoint::stage3
