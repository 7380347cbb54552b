// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/net_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace fastjoint::stage2 {
namespace {

/// Part of a section that a crack takes, on the axis across it.
struct Taken {
  double from, to, thickness;
};

/// Area of the union of the parts outside the hole.
double area_beside(const rim::Rim& rim, double center, std::vector<Taken> parts) {
  double area = 0;
  parts.push_back({center - rim.radius, center + rim.radius, 0});  // takes no area, and hides what is behind it
  std::ranges::sort(parts, {}, &Taken::from);
  double covered = parts.front().from;
  for (const Taken& part : parts) {
    area += part.thickness * std::max(0.0, part.to - std::max(part.from, covered));
    covered = std::max(covered, part.to);
  }
  return area;
}

}  // namespace

NetSections::NetSections(const formats::PlateSolution& plate, const pfem::Edges& edges) : plate_(plate), edges_(edges) {
  // The two faces of a crack are edges of the border at one place, with equal digits.
  std::set<std::array<double, 4>> seen;
  for (int edge = 0; edge < edges.size(); ++edge) {
    if (!edges.is_border(edge)) continue;
    Eigen::Vector2d a = plate.mesh.nodes.col(edges.nodes(0, edge)), b = plate.mesh.nodes.col(edges.nodes(1, edge));
    if (std::pair(b.x(), b.y()) < std::pair(a.x(), a.y())) std::swap(a, b);
    if (!seen.insert({a.x(), a.y(), b.x(), b.y()}).second)
      faces_.push_back({a, b, plate.mesh.thickness[edges.sides[edge].front().element]});
  }
}

double NetSections::area(const rim::Section& section) const {
  const auto& mesh = plate_.mesh;
  const auto& rim = plate_.hole_rim[section.hole];
  const auto signed_axis = rim::signed_axis_named(section.side);
  const int axis = rim::coordinate(signed_axis.axis);
  const double gross = rim::section_area(mesh, edges_, section);
  const double net = gross - rim::bearing(mesh, edges_, rim, rim::unit_vector(signed_axis)).area;
  if (faces_.empty()) return net;
  Eigen::AlignedBox2d cell;
  for (const auto& side : section.sides)
    for (const int node : edges_.nodes.col(edges_.of(side))) {
      const Eigen::Vector2d at = mesh.nodes.col(node);
      Eigen::Vector2d beyond = at;
      beyond[axis] = 2 * rim.center[axis] - at[axis];
      cell.extend(at).extend(beyond);
    }
  std::vector<Taken> parts;
  for (const Face& face : faces_)
    if (cell.contains((face.from + face.to) / 2)) {
      const auto [low, high] = std::minmax(face.from[1 - axis], face.to[1 - axis]);
      parts.push_back({low, high, face.thickness});
    }
  constexpr double rounding = 1e-9;
  const double left = net - area_beside(rim, rim.center[1 - axis], std::move(parts));
  return left > rounding * gross ? left : 0;
}

}  // namespace fastjoint::stage2
