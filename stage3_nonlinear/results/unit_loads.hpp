// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"

namespace fastjoint::stage3 {

/// Forces of rigid fasteners under each load alone: q of the condensed system is the sum of these, each times its load.
struct UnitLoads {
  std::vector<std::string> force;         ///< (u) "plate:external" without a given displacement, loaded or not
  Eigen::MatrixXd q_force;                ///< (n a, u) per unit force, dimensionless
  std::vector<std::string> displacement;  ///< (v) "plate:external" with a given one
  Eigen::MatrixXd q_displacement;         ///< (n a, v) per unit displacement, force / length
};

/// By reciprocity q of a load is its work on the displacements D_delta, without another solve (docs/theory.md,
/// section 7.1).
[[nodiscard]] UnitLoads unit_loads(const JointModel& joint, const CondensedSystem& system);

}  // namespace fastjoint::stage3
