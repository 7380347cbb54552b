// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage3_nonlinear/interfaces/compression_only_rim.hpp"

namespace fastjoint::stage3 {

/// Friction of a rim on its plate: each wave of shear times the area of the rim.
struct RimFriction {
  VectorXd forces;       ///< (n_shears) force
  MatrixXd slopes;       ///< (n_shears, size) their derivatives by the rim's stiffness times its moments, dimensionless
  bool slips = true;     ///< else the rim sticks, and friction and pressure have equal resultants
  double direction = 0;  ///< of the force of the pressure on the plate, radians
  double excess = 1;     ///< CompressionOnlyRim::mu over the coefficient that is mobilised, 1 if the rim slips
};

/// Friction of a rim of contact whose disc slips in the direction of the resultant of its pressure:
/// CompressionOnlyRim::mu times the pressure, on both sides of that direction (docs/theory.md, section 6.5). Its
/// resultant is at most that of the pressure, which is the case of a disc that sticks to its rim; a pressure without
/// resultant has no friction.
/// @param at The arcs of contact at the moments m.
[[nodiscard]] RimFriction rim_friction(const CompressionOnlyRim& rim, const Touching& at, const VectorXd& m);

}  // namespace fastjoint::stage3
