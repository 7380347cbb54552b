// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Unit vector of a bearing side, "+x", "-x", "+y" or "-y".
[[nodiscard]] Eigen::Vector2d bearing_direction(const std::string& side);

/// Constants of the unit friction cases.
struct FrictionConstants {
  Eigen::VectorXd unit_force;  ///< (h) c, length^2
  Eigen::VectorXd resultant;   ///< (h) resultant of the friction along the axis of its direction, signed, length^2
};
[[nodiscard]] FrictionConstants friction_constants(const formats::PlateSolution& plate);

}  // namespace fastjoint::stage2
