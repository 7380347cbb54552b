// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/count.hpp"
#include "common/pfem/element.hpp"

namespace fastjoint::stage1 {
namespace {

/// Lower bound of the Jacobian ratio: a nearly folded map loses accuracy before it becomes singular.
constexpr double min_jacobian_ratio = 1e-3;

void check_elements(const PlateScene& scene, const PlateMesh& plate) {
  for (int element = 0; element < plate.mesh.n_elements(); ++element) {
    const double ratio = pfem::jacobian_ratio(pfem::ElementMap(plate.mesh, plate.edges, element));
    if (ratio > min_jacobian_ratio) continue;
    const Eigen::Vector2d center = plate.mesh.nodes(Eigen::all, plate.mesh.quads.col(element)).rowwise().mean();
    reject(scene, "/geometry",
           fmt::format("element {} near ({:g}, {:g}) is folded, clockwise or nearly so (min Jacobian / mean = {:.2g})",
                       element, center.x(), center.y(), ratio),
           fmt::format(
               "convex quadrilaterals, counter-clockwise, ratio > {:g}; {}leave more room between holes and cell "
               "lines",
               min_jacobian_ratio, scene.cracks.empty() ? "" : "draw cell lines close around a hole with cracks, or "));
  }
}

/// Sets the centre of all arcs of a rim to that of the first, so that sides with a common node have equal angles there.
/// The centres in the mesh differ by at most rim::same_place.
void share_center(const rim::Rim& rim, PlateMesh& plate) {
  const auto arc_of = [&](const pfem::Side& side) -> pfem::Arc& {
    return plate.mesh.arcs[plate.edges.arc[plate.edges.of(side)]];
  };
  for (const auto& side : rim.sides) arc_of(side).center = arc_of(rim.sides[0]).center;
}

/// True if two nodes of a rim are at one place.
bool is_cracked(const PlateMesh& plate, const rim::Rim& rim) {
  std::map<int, double> angles;
  for (const auto& side : rim.sides)
    for (const int node : plate.edges.nodes.col(plate.edges.of(side))) {
      const Eigen::Vector2d ray = plate.mesh.nodes.col(node) - rim.center;
      angles[node] = std::atan2(ray.y(), ray.x());
    }
  return std::ranges::any_of(angles, [&](const auto& one) {
    return std::ranges::any_of(angles, [&](const auto& other) {
      return one.first != other.first && std::abs(rim::wrapped(one.second - other.second)) < rim::same_angle;
    });
  });
}

void find_rims(const PlateScene& scene, PlateMesh& plate) {
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const Hole& hole = scene.holes[i];
    const std::string place = fmt::format("/holes/{}", i);
    const auto rim = rim::find_rim(plate.mesh, plate.edges, hole.center, hole.radius);
    share_center(rim, plate);
    double covered = 0;
    for (const auto& side : rim::side_angles(plate.mesh, plate.edges, rim)) covered += std::abs(side.sweep);
    if (std::ranges::none_of(std::array{4, 2, 1},
                             [&](int part) { return std::abs(covered - rim::full_turn / part) < rim::same_angle; }))
      reject(scene, place,
             fmt::format("the mesh has {:.6g} degrees of boundary arcs of radius {:g} about ({:g}, {:g})",
                         covered / rim::degree, hole.radius, hole.center.x(), hole.center.y()),
             "360 degrees, or 180 or 90 for a hole cut by lines of symmetry");
    if (const int other = index_of(plate.rims, rim.sides, &rim::Rim::sides); other < i)
      reject(scene, place,
             fmt::format("hole \"{}\" has the rim of hole \"{}\", /holes/{}", hole.id, scene.holes[other].id, other),
             "one hole at each place");
    plate.rims.push_back(rim);
    plate.is_cracked.push_back(is_cracked(plate, rim));
  }
}

/// Refuses sections next to a hole that are too short to be the cut across the sheet with the hole, whose net area
/// would be nothing or less.
void check_sections(const PlateScene& scene, const PlateMesh& plate) {
  for (const auto& section : plate.sections) {
    const double gross = rim::section_area(plate.mesh, plate.edges, section);
    const auto direction = rim::unit_vector(rim::signed_axis_named(section.side));
    const double hole = rim::bearing(plate.mesh, plate.edges, plate.rims[section.hole], direction).area;
    if (!(gross > (1 + rim::same_place) * hole))
      reject(scene, "/geometry/mesh/sections",
             fmt::format("the section of hole \"{}\" on its side {} has an area of {:.6g}, and the hole takes {:.6g}",
                         scene.holes[section.hole].id, section.side, gross, hole),
             "all edges of a cut through the sheet");
  }
}

/// Finds the vertex of every point spring, shape (points). Throws InputError with the nearest vertex if there is none,
/// or for one of two at that place.
std::vector<int> find_point_nodes(const PlateScene& scene, const pfem::Mesh& mesh) {
  constexpr double same = 1e-9;  // relative to the plate's size
  const double size = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).norm();
  std::vector<int> nodes;
  for (int i = 0; i < count_of(scene.points); ++i) {
    const Eigen::Vector2d& at = scene.points[i].at;
    int nearest = 0;
    const double distance = (mesh.nodes.colwise() - at).colwise().norm().minCoeff(&nearest);
    if (distance > same * size)
      reject(scene, fmt::format("/points/{}/at", i),
             fmt::format("({:.9g}, {:.9g}) is not a vertex of the mesh", at.x(), at.y()),
             fmt::format("vertices of the mesh; the nearest is ({:.17g}, {:.17g})", mesh.nodes(0, nearest),
                         mesh.nodes(1, nearest)));
    if (((mesh.nodes.colwise() - at).colwise().norm().array() <= same * size).count() > 1)
      reject(scene, fmt::format("/points/{}/at", i),
             fmt::format("({:.9g}, {:.9g}) is on both faces of a crack", at.x(), at.y()), "a vertex beside cracks");
    nodes.push_back(nearest);
  }
  return nodes;
}

}  // namespace

int edge_between(const PlateScene& scene, const pfem::Edges& edges, const std::string& pointer, int a, int b) {
  const int edge = edges.between(a, b);
  if (edge < 0)
    reject(scene, pointer, fmt::format("nodes {} and {} are not joined by an edge of an element", a, b),
           "edges of elements");
  return edge;
}

PlateMesh make_mesh(const PlateScene& scene) {
  PlateMesh plate = std::holds_alternative<GridGeometry>(scene.geometry)
                        ? mesh_grid(scene, std::get<GridGeometry>(scene.geometry))
                        : mesh_explicit(scene, std::get<MeshGeometry>(scene.geometry));
  std::stable_sort(plate.sections.begin(), plate.sections.end(),
                   [](const auto& a, const auto& b) { return a.hole < b.hole; });
  check_elements(scene, plate);
  find_rims(scene, plate);
  check_sections(scene, plate);
  plate.point_nodes = find_point_nodes(scene, plate.mesh);
  return plate;
}

}  // namespace fastjoint::stage1
