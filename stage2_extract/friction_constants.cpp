// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/friction_constants.hpp"

#include <algorithm>
#include <iterator>

namespace fastjoint::stage2 {

FrictionConstants friction_constants(const formats::PlateSolution& plate) {
  const auto h = static_cast<Eigen::Index>(plate.friction_hole.size());
  const auto edges = pfem::find_edges(plate.mesh);
  FrictionConstants constants{Eigen::VectorXd::Zero(h), Eigen::VectorXd::Zero(h)};
  for (Eigen::Index j = 0; j < h; ++j) {
    const auto id =
        std::find(plate.hole_id.begin(), plate.hole_id.end(), plate.friction_hole[static_cast<std::size_t>(j)]);
    const auto& rim = plate.hole_rim[static_cast<std::size_t>(std::distance(plate.hole_id.begin(), id))];
    const std::string& bearing = plate.friction_bearing[static_cast<std::size_t>(j)];
    const Eigen::Vector2d axis = pfem::axis(bearing.substr(1));
    const Eigen::Vector2d d = bearing[0] == '+' ? axis : Eigen::Vector2d(-axis);
    for (const auto& side : rim.sides) {
      constexpr int p = 8;  // only the number of points: enough for products of sines over a quarter
      const auto rule = pfem::rim_rule(plate.mesh, edges, side, p);
      for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
        const auto at = pfem::cosine_bearing(-rule.normal.col(q), d);
        const double t_ds = plate.mesh.thickness[side.element] * rule.ds[q];
        constants.unit_force[j] += t_ds * at.contact * at.contact;
        constants.resultant[j] += t_ds * at.contact * at.tangent.dot(axis);
      }
    }
  }
  return constants;
}

}  // namespace fastjoint::stage2
