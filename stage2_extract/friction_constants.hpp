// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Unit vector of a bearing side, "+x", "-x", "+y" or "-y".
[[nodiscard]] Eigen::Vector2d bearing_direction(const std::string& side);

/// Integrals over the part of a rim that bears along the unit vector d, as far as the model has it, length^2.
struct Bearing {
  double area = 0;        ///< int t cos ds: d t of a whole hole
  double unit_force = 0;  ///< c = int t cos^2 ds: bearing force per unit peak contact stress; t d pi/4 of a whole hole,
                          ///< t d pi/8 of the half hole of a symmetric model
  double resultant = 0;   ///< along d, of the unit friction case
};
[[nodiscard]] Bearing bearing_of(const formats::PlateSolution& plate, std::size_t hole, const Eigen::Vector2d& d);

/// Constants of the unit friction cases.
struct FrictionConstants {
  Eigen::VectorXd unit_force;  ///< (h) c, length^2
  Eigen::VectorXd resultant;   ///< (h) resultant of the friction along the axis of its direction, signed, length^2
};
[[nodiscard]] FrictionConstants friction_constants(const formats::PlateSolution& plate);

}  // namespace fastjoint::stage2
