// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/line_springs.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace fastjoint::stage1 {

std::vector<int> find_point_nodes(const PlateScene& scene, const pfem::Mesh& mesh) {
  constexpr double same = 1e-9;  // of the plate's size
  const double size = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).norm();
  std::vector<int> nodes;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const Eigen::Vector2d& at = scene.points[i].at;
    Eigen::Index nearest = 0;
    const double distance = (mesh.nodes.colwise() - at).colwise().norm().minCoeff(&nearest);
    if (distance > same * size)
      reject(scene, fmt::format("/points/{}/at", i),
             fmt::format("({:.9g}, {:.9g}) is not a vertex of the mesh", at.x(), at.y()),
             fmt::format("vertices of the mesh; the nearest is ({:.17g}, {:.17g})", mesh.nodes(0, nearest),
                         mesh.nodes(1, nearest)));
    nodes.push_back(static_cast<int>(nearest));
  }
  return nodes;
}

std::vector<PointTie> tie_points(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  std::vector<PointTie> ties;
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    for (std::size_t a = 0; a < scene.disc_directions.size(); ++a) {
      const std::string& direction = scene.disc_directions[a];
      const auto coefficient = static_cast<std::size_t>(2 * plate.point_nodes[i] + (direction == "x" ? 0 : 1));
      const int target = unknowns.target[coefficient];
      if (target == Unknowns::fixed)
        reject(scene, fmt::format("/points/{}/at", i),
               fmt::format("a support holds the vertex along {}, so that the spring cannot load the plate", direction),
               "vertices that are free to move along every one of \"disc_directions\"");
      ties.push_back({plate.point_nodes[i], target,
                      unknowns.controlled_of_disc(unknowns.disc_of_point[i] + static_cast<int>(a)),
                      scene.points[i].stiffness});
    }
  return ties;
}

}  // namespace fastjoint::stage1
