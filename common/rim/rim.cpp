// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/rim.hpp"

#include <algorithm>
#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::rim {
namespace {

bool on_circle(const pfem::Mesh& mesh, const pfem::Arc& arc, const Eigen::Vector2d& center, double radius,
               double tolerance) {
  return (arc.center - center).norm() < tolerance * radius &&
         std::abs((mesh.nodes.col(arc.a) - arc.center).norm() - radius) < tolerance * radius;
}

}  // namespace

Rim find_rim(const pfem::Mesh& mesh, const pfem::Edges& edges, const Eigen::Vector2d& center, double radius,
             double tolerance) {
  Rim rim{center, radius, {}};
  for (const auto& arc : mesh.arcs) {
    if (!on_circle(mesh, arc, center, radius, tolerance)) continue;
    const int edge = edges.between(arc.a, arc.b);
    if (edge >= 0 && &mesh.arcs[edges.arc[edge]] == &arc && edges.is_border(edge))
      rim.sides.push_back(edges.sides[edge].front());
  }
  std::ranges::sort(rim.sides);
  return rim;
}

std::vector<SideAngles> side_angles(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim) {
  std::vector<SideAngles> sides;
  sides.reserve(rim.sides.size());
  for (const auto& side : rim.sides) {
    const auto curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
    sides.push_back({side, curve.start_angle(), curve.sweep()});
  }
  return sides;
}

std::vector<AngleRange> open_pieces(const std::vector<SideAngles>& sides) {
  const auto meets = [](double end, double start) {
    return std::abs(wrapped(end, start - same_angle) - start) < same_angle;
  };
  std::vector<AngleRange> pieces;
  for (const auto& first : sides) {
    const auto ends_here = [&](const SideAngles& other) { return meets(other.high(), first.low()); };
    if (std::any_of(sides.begin(), sides.end(), ends_here)) continue;
    AngleRange piece{first.low(), first.high()};
    const auto goes_on = [&](const SideAngles& other) { return meets(piece.to, other.low()); };
    for (auto next = std::find_if(sides.begin(), sides.end(), goes_on); next != sides.end();
         next = std::find_if(sides.begin(), sides.end(), goes_on))
      piece.to += next->high() - next->low();
    pieces.push_back(piece);
  }
  return pieces;
}

pfem::SideRule rim_rule(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Side& side, int p,
                        const std::vector<AngleRange>& ranges) {
  constexpr double at_end = 1e-9;  // tolerance of equal breaks and ends
  const pfem::Curve curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
  const double low = std::min(curve.start_angle(), curve.start_angle() + curve.sweep());
  std::vector<double> angles = {0, full_turn / 4, full_turn / 2, -full_turn / 4};
  for (const auto& range : ranges) angles.insert(angles.end(), {range.from, range.to});
  std::vector<double> breaks;
  for (const double angle : angles) {
    const double on_side = wrapped(angle, low);
    const double s = -1 + 2 * (on_side - curve.start_angle()) / curve.sweep();
    if (std::abs(s) < 1 - at_end) breaks.push_back(s);
  }
  std::sort(breaks.begin(), breaks.end());
  const auto close = [](double a, double b) { return b - a < at_end; };
  breaks.erase(std::unique(breaks.begin(), breaks.end(), close), breaks.end());
  return pfem::side_rule(mesh, edges, side, p, breaks);
}

bool is_along(double angle, Axis axis) {
  return std::abs(axis == Axis::x ? std::sin(angle) : std::cos(angle)) < same_angle;
}

CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d) {
  const double cosine = n.dot(d);
  if (cosine <= 0) return {0, Eigen::Vector2d::Zero()};
  return {cosine, (d - cosine * n).normalized()};
}

double section_area(const pfem::Mesh& mesh, const pfem::Edges& edges, const Section& section) {
  double area = 0;
  for (const auto& side : section.sides)
    area += mesh.thickness[side.element] * pfem::side_rule(mesh, edges, side, 1).ds.sum();
  return area;
}

Bearing bearing(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim, const Eigen::Vector2d& d) {
  Bearing sum;
  const Eigen::Vector2d across = d.reverse().cwiseAbs();
  for (const auto& side : rim.sides) {
    constexpr int p = 8;  // sets the number of points: enough for products of sines over a quarter
    const auto rule = rim_rule(mesh, edges, side, p);
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q);
      const auto at = cosine_bearing(n, d);
      const double t_ds = mesh.thickness[side.element] * rule.ds[q];
      sum.area += t_ds * at.contact;
      sum.unit_force += t_ds * at.contact * at.contact;
      sum.resultant += t_ds * at.contact * at.tangent.dot(d);
      sum.force_across += t_ds * at.contact * n.dot(across);
      sum.resultant_across += t_ds * at.contact * at.tangent.dot(across);
    }
  }
  return sum;
}

}  // namespace fastjoint::rim
