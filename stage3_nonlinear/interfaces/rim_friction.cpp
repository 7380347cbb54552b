// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/rim_friction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fastjoint::stage3 {
namespace {

using Eigen::Vector2d;

/// Mean over the rim of the products of shears with pressures on the arcs of contact, times -sign(sin(theta -
/// direction)).
MatrixXd signed_products(const rim::Harmonics& pressures, const Touching& at, double direction) {
  std::vector<rim::SignedRange> pieces;
  for (const auto& arc : at.arcs) {
    std::vector<double> ends{arc.from, arc.to};
    for (double turn = rim::wrapped(direction, arc.from); turn < arc.to; turn += std::numbers::pi) ends.push_back(turn);
    if (const double back = rim::wrapped(direction, arc.from) - std::numbers::pi; back > arc.from && back < arc.to)
      ends.push_back(back);
    std::ranges::sort(ends);
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double sign = std::sin(0.5 * (ends[i - 1] + ends[i]) - direction) > 0 ? -1 : 1;
      pieces.push_back({ends[i - 1], ends[i], sign});
    }
  }
  return pressures.shear_products(pieces) / pressures.sweep;
}

}  // namespace

RimFriction rim_friction(const CompressionOnlyRim& rim, const Touching& at, const VectorXd& m) {
  const auto& pressures = rim.pressures();
  MatrixXd by_pressure(2, rim.size()), by_shear(2, pressures.n_shears());
  by_pressure << pressures.push(0).transpose(), pressures.push(1).transpose();
  by_shear << pressures.drag(0).transpose(), pressures.drag(1).transpose();
  const Vector2d b = by_pressure * rim.forces(at, m);
  const double normal = b.norm();
  RimFriction result{VectorXd::Zero(pressures.n_shears()), MatrixXd::Zero(pressures.n_shears(), rim.size())};
  if (!(normal > 0)) return result;
  const Vector2d along = b / normal;
  const double direction = result.direction = std::atan2(along.y(), along.x());
  result.slopes = rim.mu() * signed_products(pressures, at, direction);
  VectorXd c = rim.stiffness() * m;
  c[0] -= rim.stiffness() * rim.gap();
  result.forces = result.slopes * c;
  const MatrixXd db = by_pressure * at.gram;  // by c
  const Eigen::RowVectorXd turn = Eigen::RowVector2d(-along.y(), along.x()) * db / normal;
  VectorXd by_turn = VectorXd::Zero(pressures.n_shears());
  for (const double side : {1.0, -1.0}) {  // the two angles at which the shear jumps
    const double angle = direction + (side > 0 ? 0 : std::numbers::pi);
    const double pressure = rim.stiffness() * std::max(rim.depth(m, angle), 0.0);
    if (pressures.is_whole()) by_turn += side * 2 * rim.mu() / pressures.sweep * pressure * pressures.shears_at(angle);
  }
  result.slopes += by_turn * turn;
  const Vector2d tangential = by_shear * result.forces;
  const double ratio = along.dot(tangential) / normal;
  if (!(ratio > 1)) return result;
  const Vector2d across(-along.y(), along.x());
  const Eigen::RowVectorXd d_tangential = along.transpose() * by_shear * result.slopes + across.dot(tangential) * turn;
  const Eigen::RowVectorXd d_ratio = (d_tangential - ratio * along.transpose() * db) / normal;
  result.slopes = (result.slopes - result.forces / ratio * d_ratio) / ratio;
  result.forces /= ratio;
  result.slips = false;
  result.excess = ratio;
  return result;
}

}  // namespace fastjoint::stage3
