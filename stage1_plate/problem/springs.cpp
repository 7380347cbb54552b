// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/springs.hpp"

#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

double angle_of(const Eigen::Vector2d& radial) { return std::atan2(radial.y(), radial.x()); }

SideSprings distributed(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p) {
  SideSprings springs{rim::rim_rule(plate.mesh, plate.edges, side, p, spring.acts), {}};
  springs.weight = spring.modulus * plate.mesh.thickness[side.element] * springs.rule.ds;
  for (Eigen::Index q = 0; q < springs.weight.size(); ++q)
    if (!rim::covers(spring.acts, angle_of(-springs.rule.normal.col(q)))) springs.weight[q] = 0;
  return springs;
}

/// Each end of the side has half a link, if springs act on the side there.
SideSprings links(const Spring& spring, const PlateMesh& plate, const pfem::Side& side) {
  constexpr double inside = 1e-9;  // of the side: as close as rim::rim_rule takes an arc's end for the side's
  const pfem::Curve curve = pfem::edge_curve(plate.mesh, plate.edges, side.element, side.local_edge);
  const auto [first, second] = pfem::natural_ends(side.local_edge);
  SideSprings springs{
      {{first, second}, Eigen::Matrix2d::Identity(), Eigen::Matrix2Xd(2, 2), Eigen::Matrix2Xd(2, 2), {}},
      Eigen::Vector2d::Zero()};
  for (const int end : {0, 1}) {
    const double angle = curve.start_angle() + end * curve.sweep();
    springs.rule.x.col(end) = curve.point(end == 0 ? -1 : 1);
    springs.rule.normal.col(end) = -Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const double beside = angle + (end == 0 ? inside : -inside) * curve.sweep();
    if (rim::covers(spring.acts, beside)) springs.weight[end] = spring.link / 2;
  }
  return springs;
}

}  // namespace

rim::HoleSpring spring_of(const Hole& hole) {
  if (!hole.spring) return {};
  return {hole.spring->modulus, hole.spring->acts};
}

SideSprings side_springs(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p) {
  return spring.link > 0 ? links(spring, plate, side) : distributed(spring, plate, side, p);
}

}  // namespace fastjoint::stage1
