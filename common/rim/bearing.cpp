// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/bearing.hpp"

#include <cassert>

namespace fastjoint::rim {

Eigen::Vector2d axis(const std::string& direction) {
  assert(direction == "x" || direction == "y");
  return direction == "x" ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
}

CosineBearing cosine_bearing(const Eigen::Vector2d& n, const Eigen::Vector2d& d) {
  const double cosine = n.dot(d);
  if (cosine <= 0) return {0, Eigen::Vector2d::Zero()};
  return {cosine, (d - cosine * n).normalized()};
}

Bearing bearing(const pfem::Mesh& mesh, const pfem::Edges& edges, const Rim& rim, const Eigen::Vector2d& d) {
  Bearing sum;
  for (const auto& side : rim.sides) {
    constexpr int p = 8;  // only the number of points: enough for products of sines over a quarter
    const auto rule = rim_rule(mesh, edges, side, p);
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const auto at = cosine_bearing(-rule.normal.col(q), d);
      const double t_ds = mesh.thickness[side.element] * rule.ds[q];
      sum.area += t_ds * at.contact;
      sum.unit_force += t_ds * at.contact * at.contact;
      sum.resultant += t_ds * at.contact * at.tangent.dot(d);
    }
  }
  return sum;
}

}  // namespace fastjoint::rim
