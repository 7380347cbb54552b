// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/rim_stress.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "common/pfem/legendre.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/pfem/strain.hpp"
#include "common/rim/bearing.hpp"

namespace fastjoint::stage2 {
namespace {

constexpr double same_angle = 1e-7;

/// A side of a rim by its angles.
struct SideAngles {
  pfem::Side side;
  double start, sweep;  ///< at s = -1, and its increase up to s = 1

  [[nodiscard]] double low() const { return std::min(start, start + sweep); }
  [[nodiscard]] double high() const { return std::max(start, start + sweep); }
};

/// The multiple of a full turn away from `angle` in [low - same_angle, low - same_angle + full turn).
double turned(double angle, double low) { return rim::wrapped(angle, low - same_angle); }

std::vector<SideAngles> all_sides(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim) {
  std::vector<SideAngles> sides;
  sides.reserve(rim.sides.size());
  for (const auto& side : rim.sides) {
    const auto curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
    sides.push_back({side, curve.start_angle(), curve.sweep()});
  }
  return sides;
}

/// A part of a rim without gaps.
struct Piece {
  double from, to;
};

/// The pieces that end somewhere; none of a closed rim.
std::vector<Piece> open_pieces(const std::vector<SideAngles>& sides) {
  const auto meets = [](double end, double start) { return std::abs(turned(end, start) - start) < same_angle; };
  std::vector<Piece> pieces;
  for (const auto& first : sides) {
    const auto ends_here = [&](const SideAngles& other) { return meets(other.high(), first.low()); };
    if (std::any_of(sides.begin(), sides.end(), ends_here)) continue;
    Piece piece{first.low(), first.high()};
    const auto goes_on = [&](const SideAngles& other) { return meets(piece.to, other.low()); };
    for (auto next = std::find_if(sides.begin(), sides.end(), goes_on); next != sides.end();
         next = std::find_if(sides.begin(), sides.end(), goes_on))
      piece.to += next->high() - next->low();
    pieces.push_back(piece);
  }
  return pieces;
}

RimPoint point_at(const std::vector<SideAngles>& sides, double angle) {
  RimPoint point{angle, {}};
  for (const auto& side : sides) {
    const double inside = turned(angle, side.low());
    if (inside > side.high() + same_angle) continue;
    const double s = -1 + 2 * (inside - side.start) / side.sweep;
    point.on.push_back({side.side, std::clamp(s, -1.0, 1.0), 2 / side.sweep});
  }
  return point;
}

/// Displacement and hoop strain at a point of one side in every case.
struct Trace {
  Eigen::RowVectorXd u_n;     ///< along the radial direction, length
  Eigen::RowVectorXd eps_tt;  ///< dimensionless
};

struct Frame {
  Eigen::Vector2d n, t;  ///< radial and hoop direction
};

Frame frame_at(double angle) { return {{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}}; }

Trace trace(const UnitFields& fields, const OnSide& at, const Frame& frame, double radius) {
  const auto shape = pfem::integrated_legendre(fields.p(), Eigen::VectorXd::Constant(1, at.s));
  const Eigen::MatrixXd C = fields.coefficients(at.side.element, pfem::modes_on_edge(fields.p(), at.side.local_edge));
  const auto n = shape.N.rows();
  const auto along = [&](const Eigen::Vector2d& e, const Eigen::MatrixXd& values) -> Eigen::RowVectorXd {
    return values.col(0).transpose() * (e.x() * C.topRows(n) + e.y() * C.bottomRows(n));
  };
  return {along(frame.n, shape.N), along(frame.t, shape.dN) * at.ds_dtheta / radius};
}

/// Amount by which each case moves the disc of a hole along n, shape (n_cases).
Eigen::RowVectorXd disc_motion(const UnitFields& fields, std::size_t hole, const Eigen::Vector2d& n) {
  const auto& plate = fields.plate();
  Eigen::RowVectorXd motion = Eigen::RowVectorXd::Zero(fields.n_cases());
  for (std::size_t i = 0; i < plate.disc_hole.size(); ++i)
    if (plate.disc_hole[i] == plate.hole_id[hole])
      motion[plate.external_id.size() + i] = rim::axis(plate.disc_direction[i]).dot(n);
  return motion;
}

Eigen::RowVectorXd radial_stress(const UnitFields& fields, std::size_t hole, double angle, const Eigen::Vector2d& n,
                                 const Eigen::RowVectorXd& u_n) {
  const auto& plate = fields.plate();
  const auto& spring = plate.hole_spring[hole];
  Eigen::RowVectorXd sigma = Eigen::RowVectorXd::Zero(fields.n_cases());
  if (rim::covers(spring.acts, angle)) sigma = spring.modulus * (u_n - disc_motion(fields, hole, n));
  const Eigen::Index q = plate.traction_hole.size();
  for (Eigen::Index i = 0; i < q; ++i) {
    if (plate.traction_hole[i] != plate.hole_id[hole]) continue;
    const Eigen::Vector2d d = rim::axis(plate.traction_direction[i]);
    sigma[fields.n_cases() - q + i] -= rim::cosine_bearing(n, d).contact /
                                       rim::bearing(plate.mesh, fields.edges(), plate.hole_rim[hole], d).unit_force;
  }
  return sigma;
}

/// The friction pulls at the plate by sigma . (-n).
Eigen::RowVectorXd shear_stress(const UnitFields& fields, std::size_t hole, const Frame& frame) {
  const auto& plate = fields.plate();
  Eigen::RowVectorXd sigma = Eigen::RowVectorXd::Zero(fields.n_cases());
  const auto first = plate.K_cc.cols();
  for (std::size_t i = 0; i < plate.friction_hole.size(); ++i) {
    if (plate.friction_hole[i] != plate.hole_id[hole]) continue;
    const auto at = rim::cosine_bearing(frame.n, bearing_direction(plate.friction_bearing[i]));
    sigma[first + i] = -at.contact * at.tangent.dot(frame.t);
  }
  return sigma;
}

}  // namespace

std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim) {
  const auto sides = all_sides(mesh, edges, rim);
  constexpr double step = rim::full_turn / n_points_per_turn;
  std::vector<RimPoint> points;
  if (sides.empty()) return points;
  const auto pieces = open_pieces(sides);
  if (pieces.empty())
    for (int i = 0; i < n_points_per_turn; ++i) points.push_back(point_at(sides, i * step));
  for (const auto& piece : pieces) {
    const int n_steps = std::max(1, static_cast<int>(std::lround((piece.to - piece.from) / step)));
    for (int i = 0; i <= n_steps; ++i)
      points.push_back(point_at(sides, piece.from + i * (piece.to - piece.from) / n_steps));
  }
  return points;
}

Eigen::Vector2d bearing_direction(const std::string& side) {
  const Eigen::Vector2d axis = rim::axis(side.substr(1));
  return side[0] == '+' ? axis : Eigen::Vector2d(-axis);
}

Eigen::MatrixXd rim_stress(const UnitFields& fields, std::size_t hole, const RimPoint& point) {
  const Frame frame = frame_at(point.angle);
  const double radius = fields.plate().hole_rim[hole].radius;
  const Eigen::Matrix3d to_global = pfem::polar_stress(-point.angle);
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(3, fields.n_cases());
  for (const auto& at : point.on) {
    const Trace side = trace(fields, at, frame, radius);
    const Eigen::Matrix3d compliance = to_global.transpose() * fields.elasticity(at.side.element).inverse() * to_global;
    Eigen::MatrixXd sigma(3, fields.n_cases());
    sigma.row(0) = radial_stress(fields, hole, point.angle, frame.n, side.u_n);
    sigma.row(2) = shear_stress(fields, hole, frame);
    sigma.row(1) = (side.eps_tt - compliance(1, 0) * sigma.row(0) - compliance(1, 2) * sigma.row(2)) / compliance(1, 1);
    mean += sigma / count_of(point.on);
  }
  return mean;
}

}  // namespace fastjoint::stage2
