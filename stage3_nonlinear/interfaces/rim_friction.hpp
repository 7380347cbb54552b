// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage3_nonlinear/interfaces/rim_contact.hpp"

namespace fastjoint::stage3 {

/// Forces of the shears of a rim on its plate: the amount of each shear times the area of the rim.
struct RimFriction {
  VectorXd forces;       ///< (n_shears) force
  MatrixXd slopes;       ///< (n_shears, size) their derivatives by the rim's stiffness times its moments, dimensionless
  bool slips = true;     ///< all of it; else it sticks, and friction carries as much of the load as pressure does
  double direction = 0;  ///< of the force of the pressure on the plate, radians
  double share = 1;      ///< what friction at RimContact::mu would carry over what it does
};

/// Friction of a rim of contact with its disc, which slips in the direction of the force of its pressure and drags the
/// plate along: RimContact::mu times the pressure, on both sides of that direction (docs/theory.md, section 6.5). It
/// never carries more than the pressure does, as around a disc that sticks to its rim; a pressure without resultant has
/// no friction.
/// @param at What touches at the moments m.
[[nodiscard]] RimFriction rim_friction(const RimContact& rim, const Touching& at, const VectorXd& m);

}  // namespace fastjoint::stage3
