// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/line_springs.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace fastjoint::stage1 {

std::vector<PointTie> tie_points(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  std::vector<PointTie> ties;
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    for (std::size_t a = 0; a < scene.disc_directions.size(); ++a) {
      const std::string& direction = scene.disc_directions[a];
      const std::size_t coefficient = 2 * plate.point_nodes[i] + (direction == "x" ? 0 : 1);
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
