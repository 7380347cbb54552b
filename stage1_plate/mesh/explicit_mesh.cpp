// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  constexpr double tolerance = 1e-6;  // of the radius: digits that a hand-written file has
  for (std::size_t i = 0; i < mesh.arcs.size(); ++i) {
    const auto& arc = mesh.arcs[i];
    const std::string place = fmt::format("/geometry/mesh/arcs/{}", i);
    const double from = (mesh.nodes.col(arc.a) - arc.center).norm();
    const double to = (mesh.nodes.col(arc.b) - arc.center).norm();
    if (!(std::abs(from - to) < tolerance * from))
      reject(scene, place, fmt::format("its ends are {:.9g} and {:.9g} from the centre", from, to), "equal distances");
    const auto curve = pfem::Curve::arc(mesh.nodes.col(arc.a), mesh.nodes.col(arc.b), arc.center);
    constexpr double longest = 3.0;  // radians; at pi it is no longer clear which way the arc runs
    if (std::abs(curve.sweep()) > longest)
      reject(scene, place, fmt::format("an arc of {:.4g} radians", std::abs(curve.sweep())),
             fmt::format("at most {:g} radians; cut it in two", longest));
  }
  if (!edges.arc_without_edge.empty()) {
    const int i = edges.arc_without_edge.front();
    const auto& arc = mesh.arcs[i];
    reject(scene, fmt::format("/geometry/mesh/arcs/{}/edge", i),
           fmt::format("nodes {} and {} are not joined by an edge of an element", arc.a, arc.b), "edges of elements");
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

/// Coordinate of a point along an edge, 0 to 1 from its first to its last node, and how far off the edge it lies over
/// its length.
std::pair<double, double> place_on(const pfem::Mesh& mesh, const pfem::Edges& edges, int edge,
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
  const double turned = std::remainder(std::atan2(ray.y(), ray.x()) - curve.start_angle(), rim::full_turn);
  const double radius = (a - center).norm();
  return {turned / curve.sweep(), std::abs(ray.norm() - radius) / (radius * std::abs(curve.sweep()))};
}

/// Whether an edge joins two nodes, however short it is.
bool are_joined(const pfem::Edges& edges, int a, int b) {
  return (edges.nodes.row(0).array() == std::min(a, b) && edges.nodes.row(1).array() == std::max(a, b)).any();
}

/// A node on the edge of an element that does not have it would make the displacements discontinuous.
void check_hanging_nodes(const PlateScene& scene, const pfem::Mesh& mesh, const pfem::Edges& edges) {
  constexpr double end = 1e-9, tolerance = 1e-6;  // of the edge's length: digits that a hand-written file has
  std::vector<int> border;
  for (int edge = 0; edge < edges.size(); ++edge)
    if (edges.n_elements[edge] == 1) border.push_back(edge);
  for (const int edge : border)
    for (const int node : edges.nodes(Eigen::all, border).reshaped()) {
      if ((edges.nodes.col(edge).array() == node).any()) continue;
      const auto [along, off] = place_on(mesh, edges, edge, mesh.nodes.col(node));
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

}  // namespace

pfem::Mesh to_mesh(const MeshGeometry& geometry) {
  pfem::Mesh mesh;
  const Eigen::Index n = geometry.quads.size();
  mesh.nodes.resize(2, geometry.nodes.size());
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) mesh.nodes.col(i) = geometry.nodes[i];
  mesh.quads.resize(4, n);
  for (Eigen::Index i = 0; i < n; ++i) mesh.quads.col(i) = geometry.quads[i];
  mesh.arcs = geometry.arcs;
  mesh.thickness = Eigen::Map<const Eigen::VectorXd>(geometry.thickness.data(), n);
  mesh.material = Eigen::Map<const Eigen::VectorXi>(geometry.material.data(), n);
  return mesh;
}

PlateMesh mesh_explicit(const PlateScene& scene, const MeshGeometry& geometry) {
  PlateMesh plate;
  plate.mesh = to_mesh(geometry);
  plate.edges = pfem::find_edges(plate.mesh);
  check_nodes(scene, plate.mesh);
  check_arcs(scene, plate.mesh, plate.edges);
  check_shared_edges(scene, plate.edges);
  check_hanging_nodes(scene, plate.mesh, plate.edges);
  name_edges(scene, geometry, plate);
  return plate;
}

}  // namespace fastjoint::stage1
