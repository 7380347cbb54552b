// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>
#include <vector>

#include "common/pfem/boundary.hpp"
#include "common/pfem/mesh.hpp"

namespace fastjoint::pfem {

/// The part of a hole's circle that the model has: all of it, or half or a quarter on lines of symmetry.
struct Rim {
  Eigen::Vector2d center;
  double radius;
  std::vector<Side> sides;
};

/// Sides of elements that lie on a circle, in the order of the elements.
[[nodiscard]] Rim find_rim(const Mesh& mesh, const Edges& edges, const Eigen::Vector2d& center, double radius);

/// Angle that the rim covers, radians.
[[nodiscard]] double covered_angle(const Mesh& mesh, const Edges& edges, const Rim& rim);

/// Part of a rim, radians counter-clockwise from x: from < to <= from + 2 pi.
struct AngleRange {
  double from, to;
  friend bool operator==(const AngleRange&, const AngleRange&) = default;
};

inline constexpr double full_turn = 2 * std::numbers::pi;

/// Whether one of the ranges covers the angle, any multiple of a full turn away.
[[nodiscard]] bool covers(const std::vector<AngleRange>& ranges, double angle);

/// Quadrature on one side of a rim. Pieces end where a rim is cut by a line through its centre along x or y: there the
/// tractions of bearing along +-x and +-y jump, kink or end; and where `ranges` end.
[[nodiscard]] SideRule rim_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p,
                                const std::vector<AngleRange>& ranges = {});

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
[[nodiscard]] Bearing bearing(const Mesh& mesh, const Edges& edges, const Rim& rim, const Eigen::Vector2d& d);

}  // namespace fastjoint::pfem
