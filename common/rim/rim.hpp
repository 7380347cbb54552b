// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/rim/axis.hpp"
#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// Tolerance of equal points and equal radii of a rim, relative to the radius: the precision of a hand-written mesh.
inline constexpr double same_place = 1e-6;
/// Tolerance of equal angles, radians: both ends of an arc and both centres may each be off by same_place.
inline constexpr double same_angle = 4 * same_place;

/// The part of a hole's circle that the model has: all of it, or half or a quarter between lines of symmetry.
struct Rim {
  Eigen::Vector2d center;
  double radius;
  std::vector<pfem::Side> sides;
};

/// Finds the sides of elements on the boundary that lie on a circle, in the order of the elements.
/// @param tolerance Of their centres and radii, relative to the radius.
[[nodiscard]] Rim find_rim(const pfem::Mesh& mesh, const pfem::Edges& edges, const Eigen::Vector2d& center,
                           double radius, double tolerance = same_place);

/// Angles of a side of a rim, radians.
struct SideAngles {
  pfem::Side side;
  double start, sweep;  ///< angle at s = -1, and its increase up to s = 1

  [[nodiscard]] double low() const { return std::min(start, start + sweep); }
  [[nodiscard]] double high() const { return std::max(start, start + sweep); }
};
[[nodiscard]] std::vector<SideAngles> side_angles(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim);

/// The connected pieces of a rim that have ends; none for a closed rim.
[[nodiscard]] std::vector<AngleRange> open_pieces(const std::vector<SideAngles>& sides);

/// Quadrature on one side of a rim. Its pieces end where `ranges` end and at the lines through the centre along x and
/// y, where the tractions of bearing along +-x and +-y, or their slopes, jump.
[[nodiscard]] pfem::SideRule rim_rule(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Side& side, int p,
                                      const std::vector<AngleRange>& ranges = {});

/// Normal springs between the rim of a hole and the rigid disc in it: distributed, or links at the nodes of the rim.
struct HoleSpring {
  double modulus = 0;                 ///< force / length^3; 0 with links and for an open hole
  double link = 0;                    ///< force / length at each node, half of it for each side that ends there
  std::vector<AngleRange> arcs = {};  ///< parts of the rim on which springs act
};

/// A spring between a vertex of the mesh and a separate disc, along the disc's direction.
struct PointSpring {
  int vertex;
  int disc;          ///< index among all discs
  double stiffness;  ///< force / length
};

/// A cut across the plate next to a hole, along sides of the elements between the cut and the hole.
struct Section {
  int hole;                       ///< index of the hole
  std::string side;               ///< on which side of the hole, "+x", "-x", "+y" or "-y"
  std::vector<pfem::Side> sides;  ///< sides of the elements on the hole's side of the cut
};

/// Area of the elements' side of a section, length^2.
[[nodiscard]] double section_area(const pfem::Mesh& mesh, const pfem::Edges& edges, const Section& section);

/// True if the line at an angle, radians counter-clockwise from x, is along the axis.
[[nodiscard]] bool is_along(double angle, Axis axis);

/// Cosine distribution on the half of a rim that bears along the unit vector d (docs/theory.md, section 4.2).
struct CosineBearing {
  double contact;           ///< contact stress over its peak: cos(theta) on the bearing half, else 0
  Eigen::Vector2d tangent;  ///< unit tangent in the direction of friction on the plate; its component along d is > 0
};
/// @param n Unit radial vector from the hole's centre. @param d Unit vector of the bearing direction.
[[nodiscard]] CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d);

/// Integrals over the half of a rim that bears along d, a unit vector along + or - an axis, as far as it is in the
/// model, length^2. "Across" is along + the other axis: those integrals are 0 for a whole hole in a sheet of one
/// thickness.
struct Bearing {
  double area = 0;  ///< int t cos ds: d t for a whole hole
  /// c = int t cos^2 ds: bearing force per unit peak contact stress; t d pi/4 for a whole hole, t d pi/8 for the half
  /// hole of a symmetric model
  double unit_force = 0;
  double resultant = 0;         ///< resultant along d of unit friction with the cosine distribution
  double force_across = 0;      ///< resultant across of the unit peak contact stress
  double resultant_across = 0;  ///< resultant across of unit friction
};
[[nodiscard]] Bearing bearing(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim,
                              const Eigen::Vector2d& d);

}  // namespace fastjoint::rim
