// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/rim.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {
namespace {

// Two points are the same, and a radius is the radius, to this share of the radius.
constexpr double tolerance = 1e-6;

bool on_circle(const Mesh& mesh, const Arc& arc, const Eigen::Vector2d& center, double radius) {
  return (arc.center - center).norm() < tolerance * radius &&
         std::abs((mesh.nodes.col(arc.a) - arc.center).norm() - radius) < tolerance * radius;
}

}  // namespace

Rim find_rim(const Mesh& mesh, const Edges& edges, const Eigen::Vector2d& center, double radius) {
  Rim rim{center, radius, {}};
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const auto global = static_cast<std::size_t>(edges.of_element(edge, element));
      const int arc = edges.arc[global];
      if (arc >= 0 && edges.n_elements[global] == 1 &&
          on_circle(mesh, mesh.arcs[static_cast<std::size_t>(arc)], center, radius))
        rim.sides.push_back({element, edge});
    }
  return rim;
}

double covered_angle(const Mesh& mesh, const Edges& edges, const Rim& rim) {
  double sum = 0;
  for (const auto& side : rim.sides) sum += std::abs(edge_curve(mesh, edges, side.element, side.local_edge).sweep());
  return sum;
}

bool covers(const std::vector<AngleRange>& ranges, double angle) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const AngleRange& range) {
    return angle - full_turn * std::floor((angle - range.from) / full_turn) <= range.to;
  });
}

SideRule rim_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p,
                  const std::vector<AngleRange>& ranges) {
  constexpr double at_end = 1e-9;  // a break this close to an end, or to another, is that one
  const Curve curve = edge_curve(mesh, edges, side.element, side.local_edge);
  const double low = std::min(curve.start_angle(), curve.start_angle() + curve.sweep());
  std::vector<double> angles = {0, full_turn / 4, full_turn / 2, -full_turn / 4};
  for (const auto& range : ranges) angles.insert(angles.end(), {range.from, range.to});
  std::vector<double> breaks;
  for (const double angle : angles) {
    const double inside = angle - full_turn * std::floor((angle - low) / full_turn);  // in [low, low + full turn)
    const double s = -1 + 2 * (inside - curve.start_angle()) / curve.sweep();
    if (std::abs(s) < 1 - at_end) breaks.push_back(s);
  }
  std::sort(breaks.begin(), breaks.end());
  const auto close = [](double a, double b) { return b - a < at_end; };
  breaks.erase(std::unique(breaks.begin(), breaks.end(), close), breaks.end());
  return side_rule(mesh, edges, side, p, breaks);
}

Eigen::Vector2d axis(const std::string& direction) {
  assert(direction == "x" || direction == "y");
  return direction == "x" ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
}

CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d) {
  const double cosine = n.dot(d);
  if (cosine <= 0) return {0, Eigen::Vector2d::Zero()};
  return {cosine, (d - cosine * n).normalized()};
}

Bearing bearing(const Mesh& mesh, const Edges& edges, const Rim& rim, const Eigen::Vector2d& d) {
  Bearing sum;
  for (const auto& side : rim.sides) {
    constexpr int p = 8;  // only the number of points: enough for products of sines over a quarter
    const auto rule = rim_rule(mesh, edges, side, p);
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const auto at = cosine_bearing(-rule.normal.col(q), d);
      const double t_ds = mesh.thickness[side.element] * rule.ds[q];
      sum.area += t_ds * at.contact;
      sum.unit_force += t_ds * at.contact * at.contact;
      sum.resultant += t_ds * at.contact * at.tangent.dot(d);
    }
  }
  return sum;
}

}  // namespace fastjoint::pfem
