// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage2_extract/stresses/unit_fields.hpp"

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

/// Unit vector of a bearing side, "+x", "-x", "+y" or "-y".
[[nodiscard]] Eigen::Vector2d bearing_direction(const std::string& side);

/// Stress at one point of the rim of a hole in every unit case, shape (3, n_cases): sigma_rr, sigma_tt, sigma_rt, mean
/// of the sides that meet there.
///
/// sigma_rr and sigma_rt are the known tractions of springs, bearing load and friction; sigma_tt follows from them and
/// the strain along the rim by the material's law, without a derivative across the rim (docs/theory.md, section 11.1).
/// tests/bench/rim_stress.cpp compares this with three other ways.
[[nodiscard]] Eigen::MatrixXd rim_stress(const UnitFields& fields, std::size_t hole, const RimPoint& point);

}  // namespace fastjoint::stage2
