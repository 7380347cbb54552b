// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/friction_constants.hpp"

#include "common/count.hpp"
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
    const auto& rim = plate.hole_rim[index_of(plate.hole_id, plate.friction_hole[j])];
    const auto bearing = rim::bearing(plate.mesh, edges, rim, bearing_direction(plate.friction_bearing[j]));
    constants.unit_force[j] = bearing.unit_force;
    constants.resultant[j] = plate.friction_bearing[j][0] == '+' ? bearing.resultant : -bearing.resultant;
  }
  return constants;
}

}  // namespace fastjoint::stage2
