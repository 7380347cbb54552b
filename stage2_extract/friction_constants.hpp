// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Constants of the unit friction cases, integrated over the rim that the model has.
struct FrictionConstants {
  Eigen::VectorXd unit_force;  ///< (h) c = int t cos^2 ds: bearing force per unit peak contact stress, length^2;
                               ///< t d pi/4 on a whole hole, t d pi/8 on the half hole of a symmetric model
  Eigen::VectorXd resultant;   ///< (h) resultant of the friction along the axis of its direction, signed, length^2
};
[[nodiscard]] FrictionConstants friction_constants(const formats::PlateSolution& plate);

}  // namespace fastjoint::stage2
