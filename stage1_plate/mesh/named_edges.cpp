// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fastjoint::stage1 {
namespace {

using NodePair = std::pair<int, int>;

std::string named(const NodePair& edge) {
  return fmt::format("the edge between nodes {} and {}", edge.first, edge.second);
}

/// The sides of the elements that have the edge: one on the border, two inside.
std::vector<pfem::Side> find_sides(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                                   const NodePair& edge) {
  std::vector<pfem::Side> sides;
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    if (const int local = pfem::local_edge_between(plate.mesh, element, edge.first, edge.second); local >= 0)
      sides.push_back({element, local});
  if (sides.empty())
    reject(scene, pointer,
           fmt::format("nodes {} and {} are not joined by an edge of an element", edge.first, edge.second),
           "edges of elements");
  return sides;
}

pfem::Side find_border_side(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                            const NodePair& edge) {
  const auto sides = find_sides(scene, plate, pointer, edge);
  if (sides.size() > 1) reject(scene, pointer, named(edge) + " is inside the plate", "edges of the border");
  return sides.front();
}

/// The line on which a section must lie: coordinate `axis` constant, on the side `sign` of the hole.
struct Cut {
  const Hole& hole;
  char direction;
  int axis;
  double sign;
};

Cut cut_of(const PlateScene& scene, const MeshSection& section) {
  const char direction = section.side[1];
  return {scene.holes[section.hole], direction, direction == 'x' ? 0 : 1, section.side[0] == '+' ? 1.0 : -1.0};
}

/// The forces over a section are integrals of one normal stress: all of it must face one way, on one line, with the
/// whole hole on one side.
/// @param line Coordinate `axis` of the first edge of the section.
void check_cut(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer, const Cut& cut,
               const NodePair& edge, const pfem::Side& side, double line) {
  constexpr double tolerance = 1e-9;      // of the edge's length
  constexpr double rim_tolerance = 1e-6;  // of the radius: digits that a hand-written file has
  if (plate.edges.arc[plate.edges.of_element(side.local_edge, side.element)] >= 0)
    reject(scene, pointer, named(edge) + " is an arc", "straight edges");
  const Eigen::Vector2d a = plate.mesh.nodes.col(edge.first);
  const Eigen::Vector2d ab = plate.mesh.nodes.col(edge.second) - a;
  if (!(std::abs(ab[cut.axis]) <= tolerance * ab.norm()))
    reject(scene, pointer,
           fmt::format("{} is not perpendicular to {}: its ends differ by {:.3g} in {}", named(edge), cut.direction,
                       std::abs(ab[cut.axis]), cut.direction),
           fmt::format("edges perpendicular to {} within {:g} of their length", cut.direction, tolerance));
  const double at = a[cut.axis];
  const std::string place = fmt::format("{} is at {} = {:.9g}", named(edge), cut.direction, at);
  if (!(std::abs(at - line) <= tolerance * ab.norm()))
    reject(scene, pointer, place, fmt::format("edges on one line; the first is at {} = {:.9g}", cut.direction, line));
  if (!(cut.sign * (at - cut.hole.center[cut.axis]) >= (1 - rim_tolerance) * cut.hole.radius))
    reject(scene, pointer, place,
           fmt::format("{} {} {:.9g}, beyond the rim of hole \"{}\" on its side {}{}", cut.direction,
                       cut.sign > 0 ? ">=" : "<=", cut.hole.center[cut.axis] + cut.sign * cut.hole.radius, cut.hole.id,
                       cut.sign > 0 ? '+' : '-', cut.direction));
}

rim::Section find_section(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                          const MeshSection& section) {
  const Cut cut = cut_of(scene, section);
  const double line = plate.mesh.nodes(cut.axis, section.edges.front().first);
  const auto how_far = [&](const pfem::Side& side) {
    return cut.sign * plate.mesh.nodes(cut.axis, plate.mesh.quads.col(side.element)).mean();
  };
  rim::Section found{section.hole, section.side, {}};
  for (std::size_t i = 0; i < section.edges.size(); ++i) {
    const std::string place = fmt::format("{}/edges/{}", pointer, i);
    const auto sides = find_sides(scene, plate, place, section.edges[i]);
    check_cut(scene, plate, place, cut, section.edges[i], sides.front(), line);
    found.sides.push_back(*std::min_element(
        sides.begin(), sides.end(), [&](const auto& one, const auto& other) { return how_far(one) < how_far(other); }));
  }
  return found;
}

}  // namespace

void name_edges(const PlateScene& scene, const MeshGeometry& geometry, PlateMesh& plate) {
  for (const auto& set : geometry.edges)
    for (std::size_t i = 0; i < set.edges.size(); ++i)
      plate.sets[set.name].push_back(
          find_border_side(scene, plate, fmt::format("/geometry/mesh/edges/{}/{}", set.name, i), set.edges[i]));
  for (std::size_t i = 0; i < geometry.sections.size(); ++i)
    plate.sections.push_back(
        find_section(scene, plate, fmt::format("/geometry/mesh/sections/{}", i), geometry.sections[i]));
}

}  // namespace fastjoint::stage1
