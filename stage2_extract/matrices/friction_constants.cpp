// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/friction_constants.hpp"

#include <algorithm>
#include <iterator>

#include "common/rim/bearing.hpp"

namespace fastjoint::stage2 {

Eigen::Vector2d bearing_direction(const std::string& side) {
  const Eigen::Vector2d axis = rim::axis(side.substr(1));
  return side[0] == '+' ? axis : Eigen::Vector2d(-axis);
}

FrictionConstants friction_constants(const formats::PlateSolution& plate) {
  const Eigen::Index h = plate.friction_hole.size();
  const auto edges = pfem::find_edges(plate.mesh);
  FrictionConstants constants{Eigen::VectorXd::Zero(h), Eigen::VectorXd::Zero(h)};
  for (Eigen::Index j = 0; j < h; ++j) {
    const auto id = std::find(plate.hole_id.begin(), plate.hole_id.end(), plate.friction_hole[j]);
    const std::size_t hole = std::distance(plate.hole_id.begin(), id);
    const auto bearing =
        rim::bearing(plate.mesh, edges, plate.hole_rim[hole], bearing_direction(plate.friction_bearing[j]));
    constants.unit_force[j] = bearing.unit_force;
    constants.resultant[j] = plate.friction_bearing[j][0] == '+' ? bearing.resultant : -bearing.resultant;
  }
  return constants;
}

}  // namespace fastjoint::stage2
