// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

void check_nodes(const PlateScene& scene, const pfem::Mesh& mesh) {
  std::vector<bool> used(mesh.n_nodes(), false);
  for (const int node : mesh.quads.reshaped()) used[node] = true;
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end())
    reject(scene, fmt::format("/geometry/mesh/nodes/{}", unused - used.begin()), "no element uses this node",
           "nodes of elements only");
}

void check_arcs(const PlateScene& scene, const pfem::Mesh& mesh, const pfem::Edges& edges) {
  std::map<std::pair<int, int>, int> arc_of_edge;  // keys: lower and higher node
  for (int i = 0; i < count_of(mesh.arcs); ++i) {
    const auto& arc = mesh.arcs[i];
    const std::string place = fmt::format("/geometry/mesh/arcs/{}", i);
    const double from = (mesh.nodes.col(arc.a) - arc.center).norm();
    const double to = (mesh.nodes.col(arc.b) - arc.center).norm();
    if (!(std::abs(from - to) < rim::same_place * from))
      reject(scene, place, fmt::format("its ends are {:.9g} and {:.9g} from the centre", from, to), "equal distances");
    const auto [first, is_new] = arc_of_edge.try_emplace(std::minmax(arc.a, arc.b), i);
    const Eigen::Vector2d& other = mesh.arcs[first->second].center;
    if (!((arc.center - other).norm() < rim::same_place * from))
      reject(scene, place + "/center",
             fmt::format("({:.9g}, {:.9g}), but the same edge is an arc about ({:.9g}, {:.9g}) by "
                         "/geometry/mesh/arcs/{}",
                         arc.center.x(), arc.center.y(), other.x(), other.y(), first->second),
             "one centre for each edge");
    const auto curve = pfem::Curve::arc(mesh.nodes.col(arc.a), mesh.nodes.col(arc.b), arc.center);
    constexpr double max_sweep = 3.0;  // radians; at pi the direction of the arc is ambiguous
    if (std::abs(curve.sweep()) > max_sweep)
      reject(scene, place, fmt::format("an arc of {:.4g} radians", std::abs(curve.sweep())),
             fmt::format("at most {:g} radians; cut it in two", max_sweep));
    (void)edge_between(scene, edges, place + "/edge", arc.a, arc.b);
  }
}

void check_shared_edges(const PlateScene& scene, const pfem::Edges& edges) {
  for (int edge = 0; edge < edges.size(); ++edge)
    if (const int n = count_of(edges.sides[edge]); n > 2)
      reject(scene, "/geometry/mesh/quads",
             fmt::format("the edge between nodes {} and {} belongs to {} elements", edges.nodes(0, edge),
                         edges.nodes(1, edge), n),
             "at most 2");
}

/// Rejects two elements with the same nodes, which check_shared_edges does not detect.
void check_repeated_elements(const PlateScene& scene, const pfem::Mesh& mesh) {
  std::map<std::array<int, 4>, int> element_of;  // keys: ascending nodes
  for (int i = 0; i < mesh.n_elements(); ++i) {
    std::array<int, 4> nodes{};
    std::ranges::copy(mesh.quads.col(i), nodes.begin());
    std::ranges::sort(nodes);
    if (const auto [found, is_new] = element_of.try_emplace(nodes, i); !is_new)
      reject(scene, fmt::format("/geometry/mesh/quads/{}", i),
             fmt::format("it has the same nodes as /geometry/mesh/quads/{}", found->second), "each element once");
  }
}

/// Coordinate of a point along an edge, 0 to 1 from its first to its last node, and its distance from the edge over the
/// edge's length.
std::pair<double, double> edge_coordinates(const pfem::Mesh& mesh, const pfem::Edges& edges, int edge,
                                           const Eigen::Vector2d& point) {
  const Eigen::Vector2d a = mesh.nodes.col(edges.nodes(0, edge)), b = mesh.nodes.col(edges.nodes(1, edge));
  const int arc = edges.arc[edge];
  if (arc < 0) {
    const double along = (point - a).dot(b - a) / (b - a).squaredNorm();
    return {along, (point - a - along * (b - a)).norm() / (b - a).norm()};
  }
  const Eigen::Vector2d& center = mesh.arcs[arc].center;
  const auto curve = pfem::Curve::arc(a, b, center);
  const Eigen::Vector2d ray = point - center;
  const double turned = rim::wrapped(std::atan2(ray.y(), ray.x()) - curve.start_angle());
  const double radius = (a - center).norm();
  return {turned / curve.sweep(), std::abs(ray.norm() - radius) / (radius * std::abs(curve.sweep()))};
}

/// Rejects nodes on the edge of an element that they do not belong to, which would make the displacements
/// discontinuous.
void check_hanging_nodes(const PlateScene& scene, const pfem::Mesh& mesh, const pfem::Edges& edges) {
  constexpr double end = 1e-9, tolerance = 1e-6;  // relative to the edge's length: precision of a hand-written file
  std::vector<int> boundary;
  for (int edge = 0; edge < edges.size(); ++edge)
    if (edges.is_border(edge)) boundary.push_back(edge);
  for (const int edge : boundary)
    for (const int node : edges.nodes(Eigen::all, boundary).reshaped()) {
      if ((edges.nodes.col(edge).array() == node).any()) continue;
      const auto [along, off] = edge_coordinates(mesh, edges, edge, mesh.nodes.col(node));
      if (!(off < tolerance && along > -tolerance && along < 1 + tolerance)) continue;
      const std::string place = fmt::format("/geometry/mesh/nodes/{}", node);
      const int side = along < 0.5 ? 0 : 1, nearest = edges.nodes(side, edge);
      if (std::hypot(along - side, off) < tolerance && edges.between(node, nearest) < 0)
        reject(
            scene, place,
            fmt::format("it lies on node {}, but no element joins the two, so that a slit opens between them", nearest),
            "one node at each place, which the elements on both sides share");
      if (along > end && along < 1 - end)
        reject(scene, place,
               fmt::format("it hangs on the edge between nodes {} and {}", edges.nodes(0, edge), edges.nodes(1, edge)),
               "elements that share whole edges");
    }
}

using NodePair = std::pair<int, int>;

std::string named(const NodePair& edge) {
  return fmt::format("the edge between nodes {} and {}", edge.first, edge.second);
}

/// Checks that an edge of a section is straight, on the line of the section and beyond the rim, since a section force
/// is the integral of one normal stress.
/// @param line Coordinate of the first edge of the section.
void check_cut(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer, const MeshSection& section,
               const NodePair& edge, double line) {
  constexpr double tolerance = 1e-9;  // relative to the edge's length
  const Hole& hole = scene.holes[section.hole];
  const auto [axis, sign] = section.side;
  const int along = rim::coordinate(axis);
  const std::string& direction = rim::name_of(axis);
  if (plate.edges.arc[plate.edges.between(edge.first, edge.second)] >= 0)
    reject(scene, pointer, named(edge) + " is an arc", "straight edges");
  const Eigen::Vector2d a = plate.mesh.nodes.col(edge.first);
  const Eigen::Vector2d ab = plate.mesh.nodes.col(edge.second) - a;
  if (!(std::abs(ab[along]) <= tolerance * ab.norm()))
    reject(scene, pointer,
           fmt::format("{} is not perpendicular to {}: its ends differ by {:.3g} in {}", named(edge), direction,
                       std::abs(ab[along]), direction),
           fmt::format("edges perpendicular to {} within {:g} of their length", direction, tolerance));
  const double at = a[along];
  const std::string place = fmt::format("{} is at {} = {:.9g}", named(edge), direction, at);
  if (!(std::abs(at - line) <= tolerance * ab.norm()))
    reject(scene, pointer, place, fmt::format("edges on one line; the first is at {} = {:.9g}", direction, line));
  if (!(sign * (at - hole.center[along]) >= (1 - rim::same_place) * hole.radius))
    reject(scene, pointer, place,
           fmt::format("{} {} {:.9g}, beyond the rim of hole \"{}\" on its side {}", direction, sign > 0 ? ">=" : "<=",
                       hole.center[along] + sign * hole.radius, hole.id, rim::name_of(section.side)));
}

rim::Section find_section(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                          const MeshSection& section) {
  const int axis = rim::coordinate(section.side.axis);
  const double line = plate.mesh.nodes(axis, section.edges.front().first);
  const auto distance = [&](const pfem::Side& side) {
    return section.side.sign * plate.mesh.nodes(axis, plate.mesh.quads.col(side.element)).mean();
  };
  rim::Section found{section.hole, rim::name_of(section.side), {}};
  for (int i = 0; i < count_of(section.edges); ++i) {
    const std::string place = fmt::format("{}/edges/{}", pointer, i);
    const auto [a, b] = section.edges[i];
    const auto& sides = plate.edges.sides[edge_between(scene, plate.edges, place, a, b)];
    check_cut(scene, plate, place, section, section.edges[i], line);
    found.sides.push_back(*std::ranges::min_element(sides, {}, distance));
  }
  return found;
}

/// Finds the named edges of an explicit mesh: sets on the boundary, and sections, whose sides belong to the elements
/// between the cut and the hole (on the boundary, to the only element).
void name_edges(const PlateScene& scene, const MeshGeometry& geometry, PlateMesh& plate) {
  for (const auto& [name, edges] : geometry.edges) {
    if (std::ranges::find(scene.cracks, name, &Crack::on) != scene.cracks.end()) continue;
    for (int i = 0; i < count_of(edges); ++i) {
      const std::string place = fmt::format("/geometry/mesh/edges/{}/{}", name, i);
      const int edge = edge_between(scene, plate.edges, place, edges[i].first, edges[i].second);
      if (!plate.edges.is_border(edge))
        reject(scene, place, named(edges[i]) + " is inside the plate", "edges of the border");
      plate.sets[name].push_back(plate.edges.sides[edge].front());
    }
  }
  for (int i = 0; i < count_of(geometry.sections); ++i)
    plate.sections.push_back(
        find_section(scene, plate, fmt::format("/geometry/mesh/sections/{}", i), geometry.sections[i]));
}

}  // namespace

PlateMesh mesh_explicit(const PlateScene& scene, const MeshGeometry& geometry) {
  PlateMesh plate;
  plate.mesh = geometry.mesh;
  plate.edges = pfem::find_edges(plate.mesh);
  check_nodes(scene, plate.mesh);
  check_arcs(scene, plate.mesh, plate.edges);
  check_shared_edges(scene, plate.edges);
  check_repeated_elements(scene, plate.mesh);
  check_hanging_nodes(scene, plate.mesh, plate.edges);
  name_edges(scene, geometry, plate);
  std::vector<CrackPath> cracks;
  for (int i = 0; i < count_of(scene.cracks); ++i)
    cracks.push_back({i, fmt::format("/cracks/{}", i), geometry.edges.at(scene.cracks[i].on)});
  open_cracks(scene, cracks, plate);
  return plate;
}

}  // namespace fastjoint::stage1
