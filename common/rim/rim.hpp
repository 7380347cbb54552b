// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// Digits that a hand-written mesh has: two points of a rim are one, and two radii are one, to this part of the radius.
inline constexpr double same_place = 1e-6;
/// Two angles as close as this are one, radians: both ends of an arc, and the centre that either is seen from, may each
/// be off by same_place.
inline constexpr double same_angle = 4 * same_place;

/// The part of a hole's circle that the model has: all of it, or half or a quarter on lines of symmetry.
struct Rim {
  Eigen::Vector2d center;
  double radius;
  std::vector<pfem::Side> sides;
};

/// The arcs on the boundary of a mesh by their centres, among which each rim is found without a look at the others.
class RimFinder {
 public:
  /// The mesh must outlive this.
  RimFinder(const pfem::Mesh& mesh, const pfem::Edges& edges);
  /// Sides of elements that lie on a circle, in the order of the elements.
  [[nodiscard]] Rim operator()(const Eigen::Vector2d& center, double radius) const;

 private:
  const pfem::Mesh& mesh_;
  std::map<double, std::map<double, std::vector<std::pair<pfem::Side, int>>>> arcs_;  ///< by x and y of the centre
};

/// A side of a rim by its angles, radians.
struct SideAngles {
  pfem::Side side;
  double start, sweep;  ///< at s = -1, and its increase up to s = 1

  [[nodiscard]] double low() const { return std::min(start, start + sweep); }
  [[nodiscard]] double high() const { return std::max(start, start + sweep); }
};
[[nodiscard]] std::vector<SideAngles> side_angles(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim);

/// The pieces of a rim that end somewhere; none of a closed one.
[[nodiscard]] std::vector<AngleRange> open_pieces(const std::vector<SideAngles>& sides);

/// Angle that the rim covers, radians.
[[nodiscard]] double covered_angle(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim);

/// Quadrature on one side of a rim. Pieces end where a rim is cut by a line through its centre along x or y: there the
/// tractions of bearing along +-x and +-y, or their slopes, jump; and where `ranges` end.
[[nodiscard]] pfem::SideRule rim_rule(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Side& side, int p,
                                      const std::vector<AngleRange>& ranges = {});

/// Normal springs between the rim of a hole and the rigid disc in it: distributed, or links at the nodes of the rim.
struct HoleSpring {
  double modulus = 0;                 ///< force / length^3; 0 with links, and of an open hole
  double link = 0;                    ///< force / length at each node, half of it for either side that ends there
  std::vector<AngleRange> acts = {};  ///< the sprung parts of the rim
};

/// A cut across the plate beside a hole, along sides of elements that lie between it and the hole.
struct Section {
  int hole;                       ///< index of the hole
  std::string side;               ///< on which side of the hole, "+x", "-x", "+y" or "-y"
  std::vector<pfem::Side> sides;  ///< elements on the hole's side of the cut
};

/// Unit vector along "x" or "y".
[[nodiscard]] Eigen::Vector2d axis(const std::string& direction);
/// True if the line at an angle, radians counter-clockwise from x, is along "x" or "y".
[[nodiscard]] bool is_along(double angle, const std::string& direction);

/// Cosine distribution on the half of a rim that bears along the unit vector d (docs/theory.md, section 4.2).
struct CosineBearing {
  double contact;           ///< contact stress per peak: cos(theta) on the bearing half, else 0
  Eigen::Vector2d tangent;  ///< unit tangent along which friction drags the plate: its part along d is positive
};
/// @param n Unit radial vector from the hole's centre. @param d Unit vector of the bearing direction.
[[nodiscard]] CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d);

/// Integrals over the part of a rim that bears along d, a unit vector along + or - an axis, as far as the model has it,
/// length^2. Those across, along + the other axis, are 0 of a whole hole in a sheet of one thickness.
struct Bearing {
  double area = 0;        ///< int t cos ds: d t of a whole hole
  double unit_force = 0;  ///< c = int t cos^2 ds: bearing force per unit peak contact stress; t d pi/4 of a whole hole,
                          ///< t d pi/8 of the half hole of a symmetric model
  double resultant = 0;   ///< along d, of unit friction with the cosine distribution
  double force_across = 0;      ///< resultant across of the unit peak contact stress
  double resultant_across = 0;  ///< resultant across of unit friction
};
[[nodiscard]] Bearing bearing(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim,
                              const Eigen::Vector2d& d);

}  // namespace fastjoint::rim
