// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Load that a joint surely does not exceed.
struct LimitLoad {
  double factor;              ///< amount of the load factor, > 0
  std::vector<Index> planes;  ///< that carry all that their laws allow there
};

/// Upper bound of the limit load by the motions that nothing but the laws resists (docs/theory.md, section 9.2), the
/// least that is found; none where no such motion meets the load, where a law that it moves allows any force, or where
/// friction adds to the laws' forces.
/// @param sign Of the load factors.
[[nodiscard]] std::optional<LimitLoad> limit_load(const JointEquations& equations, double sign);

}  // namespace fastjoint::stage3
