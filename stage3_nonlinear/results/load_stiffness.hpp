// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"

namespace fastjoint::stage3 {

/// Tangent stiffness of a joint at a loaded boundary.
struct LoadStiffness {
  std::string external;  ///< "plate:external"
  double stiffness;      ///< force / length; infinite where the boundary does not move, 0 at a limit load
};

/// Rate of force over that of displacement along the direction of each boundary with a load other than zero, under
/// proportional load (docs/theory.md, section 10): plate after plate, rigid externals before tractions. The mean
/// displacement under a traction does not include that by friction on rims at fixed discs and rigid externals.
[[nodiscard]] std::vector<LoadStiffness> tangent_stiffness(const JointModel& joint, const SolvedPoint& point);

}  // namespace fastjoint::stage3
