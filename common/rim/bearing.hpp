// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/rim/rim.hpp"

namespace fastjoint::rim {

/// Unit vector along "x" or "y".
[[nodiscard]] Eigen::Vector2d axis(const std::string& direction);

/// Cosine distribution on the half of a rim that bears along the unit vector d (docs/theory.md, section 4.2).
struct CosineBearing {
  double contact;           ///< contact stress per peak: cos(theta) on the bearing half, else 0
  Eigen::Vector2d tangent;  ///< unit tangent along which friction drags the plate: its part along d is positive
};
/// @param n Unit radial vector from the hole's centre. @param d Unit vector of the bearing direction.
[[nodiscard]] CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d);

/// Integrals over the part of a rim that bears along the unit vector d, as far as the model has it, length^2.
struct Bearing {
  double area = 0;        ///< int t cos ds: d t of a whole hole
  double unit_force = 0;  ///< c = int t cos^2 ds: bearing force per unit peak contact stress; t d pi/4 of a whole hole,
                          ///< t d pi/8 of the half hole of a symmetric model
  double resultant = 0;   ///< along d, of unit friction with the cosine distribution
};
[[nodiscard]] Bearing bearing(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim,
                              const Eigen::Vector2d& d);

}  // namespace fastjoint::rim
