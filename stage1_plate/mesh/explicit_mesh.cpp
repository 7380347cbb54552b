// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/crack_mesh.hpp"
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

[[noreturn]] void reject_edge(const PlateScene& scene, const std::string& pointer, int a, int b) {
  reject(scene, pointer, fmt::format("nodes {} and {} are not joined by an edge of an element", a, b),
         "edges of elements");
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
  }
  if (!edges.arc_without_edge.empty()) {
    const int i = edges.arc_without_edge.front();
    reject_edge(scene, fmt::format("/geometry/mesh/arcs/{}/edge", i), mesh.arcs[i].a, mesh.arcs[i].b);
  }
}

void check_shared_edges(const PlateScene& scene, const pfem::Edges& edges) {
  for (int edge = 0; edge < edges.size(); ++edge)
    if (const int n = edges.n_elements[edge]; n > 2)
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

/// True if two nodes are the ends of an edge.
bool are_joined(const pfem::Edges& edges, int a, int b) {
  return (edges.nodes.row(0).array() == std::min(a, b) && edges.nodes.row(1).array() == std::max(a, b)).any();
}

/// Rejects nodes on the edge of an element that they do not belong to, which would make the displacements
/// discontinuous.
void check_hanging_nodes(const PlateScene& scene, const pfem::Mesh& mesh, const pfem::Edges& edges) {
  constexpr double end = 1e-9, tolerance = 1e-6;  // relative to the edge's length: precision of a hand-written file
  std::vector<int> boundary;
  for (int edge = 0; edge < edges.size(); ++edge)
    if (edges.n_elements[edge] == 1) boundary.push_back(edge);
  for (const int edge : boundary)
    for (const int node : edges.nodes(Eigen::all, boundary).reshaped()) {
      if ((edges.nodes.col(edge).array() == node).any()) continue;
      const auto [along, off] = edge_coordinates(mesh, edges, edge, mesh.nodes.col(node));
      if (!(off < tolerance && along > -tolerance && along < 1 + tolerance)) continue;
      const std::string place = fmt::format("/geometry/mesh/nodes/{}", node);
      const int side = along < 0.5 ? 0 : 1, nearest = edges.nodes(side, edge);
      if (std::hypot(along - side, off) < tolerance && !are_joined(edges, node, nearest))
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

/// The sides of the elements that have the edge: one on the boundary of the plate, two in its interior.
std::vector<pfem::Side> find_sides(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                                   const NodePair& edge) {
  const Eigen::Vector2i nodes = {std::min(edge.first, edge.second), std::max(edge.first, edge.second)};
  std::vector<pfem::Side> sides;
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    for (int local = 0; local < 4; ++local)
      if (plate.edges.nodes.col(plate.edges.of_element(local, element)) == nodes) sides.push_back({element, local});
  if (sides.empty()) reject_edge(scene, pointer, edge.first, edge.second);
  return sides;
}

pfem::Side find_boundary_side(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                              const NodePair& edge) {
  const auto sides = find_sides(scene, plate, pointer, edge);
  if (sides.size() > 1) reject(scene, pointer, named(edge) + " is inside the plate", "edges of the border");
  return sides.front();
}

/// The line on which a section must lie: coordinate `axis` constant, on the side `sign` of the hole.
struct Cut {
  const Hole& hole;
  const std::string& direction;
  int axis;
  double sign;
};

Cut cut_of(const PlateScene& scene, const MeshSection& section) {
  const auto [axis, sign] = section.side;
  return {scene.holes[section.hole], rim::name_of(axis), rim::coordinate(axis), static_cast<double>(sign)};
}

/// Checks that an edge of a section is straight, on the line of the section and beyond the rim, since a section force
/// is the integral of one normal stress.
/// @param line Coordinate of the first edge of the section.
void check_cut(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer, const Cut& cut,
               const NodePair& edge, const pfem::Side& side, double line) {
  constexpr double tolerance = 1e-9;  // relative to the edge's length
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
  if (!(cut.sign * (at - cut.hole.center[cut.axis]) >= (1 - rim::same_place) * cut.hole.radius))
    reject(scene, pointer, place,
           fmt::format("{} {} {:.9g}, beyond the rim of hole \"{}\" on its side {}{}", cut.direction,
                       cut.sign > 0 ? ">=" : "<=", cut.hole.center[cut.axis] + cut.sign * cut.hole.radius, cut.hole.id,
                       cut.sign > 0 ? '+' : '-', cut.direction));
}

rim::Section find_section(const PlateScene& scene, const PlateMesh& plate, const std::string& pointer,
                          const MeshSection& section) {
  const Cut cut = cut_of(scene, section);
  const double line = plate.mesh.nodes(cut.axis, section.edges.front().first);
  const auto distance = [&](const pfem::Side& side) {
    return cut.sign * plate.mesh.nodes(cut.axis, plate.mesh.quads.col(side.element)).mean();
  };
  rim::Section found{section.hole, rim::name_of(section.side), {}};
  for (int i = 0; i < count_of(section.edges); ++i) {
    const std::string place = fmt::format("{}/edges/{}", pointer, i);
    const auto sides = find_sides(scene, plate, place, section.edges[i]);
    check_cut(scene, plate, place, cut, section.edges[i], sides.front(), line);
    found.sides.push_back(*std::min_element(sides.begin(), sides.end(), [&](const auto& one, const auto& other) {
      return distance(one) < distance(other);
    }));
  }
  return found;
}

/// Finds the named edges of an explicit mesh: sets on the boundary, and sections, whose sides belong to the elements
/// between the cut and the hole (on the boundary, to the only element).
void name_edges(const PlateScene& scene, const MeshGeometry& geometry, PlateMesh& plate) {
  const auto is_crack = [&](const std::string& name) {
    return std::ranges::any_of(scene.cracks, [&](const Crack& crack) { return crack.on == name; });
  };
  for (const auto& [name, edges] : geometry.edges)
    for (int i = 0; i < count_of(edges) && !is_crack(name); ++i)
      plate.sets[name].push_back(
          find_boundary_side(scene, plate, fmt::format("/geometry/mesh/edges/{}/{}", name, i), edges[i]));
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
