// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Upper bound of the limit load of a joint.
struct LimitLoad {
  double factor;              ///< absolute value of the load factor, > 0
  std::vector<Index> planes;  ///< planes at the maximum force of their laws
};

/// Upper bound of the limit load by the kinematic theorem, for motions that only the laws resist (docs/theory.md,
/// section 9.2), the smallest that is found. None if the load does no work on such a motion, if a law that it moves has
/// no maximum force, or if friction adds to the forces of the laws.
/// @param sign Of the load factors.
[[nodiscard]] std::optional<LimitLoad> limit_load(const JointEquations& equations, double sign);

}  // namespace fastjoint::stage3
