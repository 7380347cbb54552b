// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/rim/rim.hpp"

namespace fastjoint::stage2 {

/// A point of a rim as one side of it sees the point.
struct OnSide {
  pfem::Side side;
  double s;          ///< coordinate along the side's natural direction, in [-1, 1]
  double ds_dtheta;  ///< of that coordinate by the angle, 1 / radian
};

/// A point of a rim, and the one or two sides that meet there.
struct RimPoint {
  double angle;  ///< radians counter-clockwise from x
  std::vector<OnSide> on;
};

/// Steps of 5 degrees: the largest of a stress that goes as cos 2 theta, read off the parabola through three points,
/// is then known to 1e-4 of it.
inline constexpr int n_points_per_turn = 72;

/// Points all around a whole rim from 0 on, or from one end of a part of it to the other, both included, in as many
/// equal steps as come closest to 5 degrees. No point of a rim without sides.
[[nodiscard]] std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim);

}  // namespace fastjoint::stage2
