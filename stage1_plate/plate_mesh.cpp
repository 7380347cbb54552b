// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/pfem/element_map.hpp"
#include "common/pfem/element_stiffness.hpp"
#include "stage1_plate/explicit_mesh.hpp"
#include "stage1_plate/grid_mesher.hpp"
#include "stage1_plate/line_springs.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A map that is nearly folded costs accuracy long before it costs uniqueness.
constexpr double least_jacobian_ratio = 1e-3;

void check_elements(const PlateScene& scene, const PlateMesh& plate) {
  for (int element = 0; element < plate.mesh.n_elements(); ++element) {
    const double ratio = pfem::jacobian_ratio(pfem::ElementMap(plate.mesh, plate.edges, element));
    if (ratio > least_jacobian_ratio) continue;
    const Eigen::Vector2d center = plate.mesh.nodes(Eigen::all, plate.mesh.quads.col(element)).rowwise().mean();
    reject(
        scene, "/geometry",
        fmt::format("element {} near ({:g}, {:g}) is folded, clockwise or nearly so (least Jacobian / mean = {:.2g})",
                    element, center.x(), center.y(), ratio),
        fmt::format(
            "convex quadrilaterals, counter-clockwise, ratio > {:g}; leave more room between holes and cell lines",
            least_jacobian_ratio));
  }
}

void find_rims(const PlateScene& scene, PlateMesh& plate) {
  for (std::size_t i = 0; i < scene.holes.size(); ++i) {
    const Hole& hole = scene.holes[i];
    plate.rims.push_back(pfem::find_rim(plate.mesh, plate.edges, hole.center, hole.radius));
    const double covered = pfem::covered_angle(plate.mesh, plate.edges, plate.rims.back()) / degree;
    bool known = false;
    for (const double whole : {90.0, 180.0, 360.0}) known = known || std::abs(covered - whole) < 1e-4;
    if (!known)
      reject(scene, fmt::format("/holes/{}", i),
             fmt::format("the mesh has {:.6g} degrees of boundary arcs of radius {:g} about ({:g}, {:g})", covered,
                         hole.radius, hole.center.x(), hole.center.y()),
             "360 degrees, or 180 or 90 for a hole cut by lines of symmetry");
  }
}

}  // namespace

PlateMesh make_mesh(const PlateScene& scene) {
  PlateMesh plate = std::holds_alternative<GridGeometry>(scene.geometry)
                        ? mesh_grid(scene, std::get<GridGeometry>(scene.geometry))
                        : mesh_explicit(scene, std::get<MeshGeometry>(scene.geometry));
  std::stable_sort(plate.sections.begin(), plate.sections.end(),
                   [](const auto& a, const auto& b) { return a.hole < b.hole; });
  check_elements(scene, plate);
  find_rims(scene, plate);
  plate.point_nodes = find_point_nodes(scene, plate.mesh);
  return plate;
}

}  // namespace fastjoint::stage1
