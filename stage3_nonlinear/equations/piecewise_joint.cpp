// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/piecewise_joint.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <iterator>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Corners of a plane over all of c, ascending.
/// @param zero True if c = 0 counts as a corner.
std::vector<double> corners(const Contact& contact, bool zero) {
  const std::vector<double> corners =
      contact.law->corners(contact.stiffness, contact.clearance).value_or(std::vector<double>{});
  std::vector<double> result = corners;
  if (!contact.one_sided) std::transform(corners.begin(), corners.end(), std::back_inserter(result), std::negate<>());
  if (zero) result.push_back(0);
  std::sort(result.begin(), result.end());
  return result;
}

/// Distance to a point inside the first or last piece: as far out again as its corner is, so that no unit of force
/// loses digits.
double outward(double corner) { return corner != 0 ? std::abs(corner) : 1.0; }

CornerCurve make_curve(const Contact& contact, bool friction) {
  const bool bears_at_once = contact.law->at(0, contact.stiffness, contact.clearance).dF > 0;
  CornerCurve curve{corners(contact, friction || (contact.one_sided && bears_at_once)), {}, {}, {}, {}, {}};
  const auto& at = curve.corners;
  const Index m = std::ssize(at) + 1;
  for (auto* each : {&curve.F0, &curve.dF, &curve.delta0, &curve.ddelta}) each->resize(m);
  curve.sign.resize(m);
  for (Index i = 0; i < m; ++i) {
    const double low = i == 0 ? (at.empty() ? 0 : at[0] - outward(at[0])) : at[i - 1];
    const double high = i == m - 1 ? low + outward(low) : at[i];
    const double c = 0.5 * (low + high);
    const auto state = contact_state({contact}, VectorXd::Constant(1, c));
    curve.dF[i] = state.dF.along[0];
    curve.ddelta[i] = state.ddelta.along[0];
    curve.F0[i] = state.F[0] - curve.dF[i] * c;
    curve.delta0[i] = state.delta[0] - curve.ddelta[i] * c;
    curve.sign[i] = c < 0 ? -1 : 1;
  }
  return curve;
}

}  // namespace

std::size_t CornerCurve::piece_of(double c) const {
  return std::upper_bound(corners.begin(), corners.end(), c) - corners.begin();
}

bool is_piecewise_linear(const JointEquations& equations) {
  const auto& contacts = equations.contacts;
  return equations.n_directions() == 1 && std::all_of(contacts.begin(), contacts.end(), [](const Contact& c) {
           return c.law->corners(c.stiffness, c.clearance).has_value();
         });
}

PiecewiseJoint::PiecewiseJoint(const JointEquations& equations) : system_(&equations.system) {
  assert(is_piecewise_linear(equations));
  std::vector<bool> alone(equations.contacts.size(), false);
  for (Index at = 0; at < system_->E.rows(); ++at) {
    Rim& rim = rims_.emplace_back(Rim{at, {}});
    for (Index plane = 0; plane < system_->E.cols(); ++plane)
      if (const double sign = system_->E(at, plane); sign != 0) rim.planes.emplace_back(plane, sign);
    if (rim.planes.size() > 1) {
      shared_rims_.push_back(at);
    } else {
      alone[rim.planes[0].first] = true;
    }
  }
  for (std::size_t j = 0; j < alone.size(); ++j) curves_.push_back(make_curve(equations.contacts[j], alone[j]));
}

Cell PiecewiseJoint::start() const {
  Cell cell;
  for (const auto& curve : curves_) cell.piece.push_back(curve.piece_of(0));
  cell.side.assign(system_->E.rows(), 1);
  follow_signs(cell);
  return cell;
}

void PiecewiseJoint::follow_signs(Cell& cell) const {
  for (const Rim& rim : rims_) {
    if (rim.planes.size() > 1) continue;
    const auto& [plane, sign] = rim.planes[0];
    const int of_force = curves_[plane].sign[cell.piece[plane]];
    cell.side[rim.at] = sign > 0 ? of_force : -of_force;
  }
}

CellEquations PiecewiseJoint::equations(const Cell& cell) const {
  const Index n = curves_.size();
  Eigen::MatrixXd on_forces = Eigen::MatrixXd::Identity(n, n);
  for (const Rim& rim : rims_)
    for (const auto& [plane, sign] : rim.planes) {
      const bool plus = cell.side[rim.at] > 0;
      const auto H = plus ? system_->H_plus.col(rim.at) : system_->H_minus.col(rim.at);
      on_forces.col(plane) += (plus ? sign : -sign) * H;
    }
  const auto of = [&](VectorXd CornerCurve::*values) {
    return VectorXd(VectorXd::NullaryExpr(n, [&](Index j) { return (curves_[j].*values)[cell.piece[j]]; }));
  };
  return {system_->S_ud * of(&CornerCurve::ddelta).asDiagonal() + on_forces * of(&CornerCurve::dF).asDiagonal(),
          system_->S_ud * of(&CornerCurve::delta0) + on_forces * of(&CornerCurve::F0)};
}

double PiecewiseJoint::rim_rate(const Cell& cell, Index rim, const VectorXd& rate) const {
  double sum = 0;
  for (const auto& [plane, sign] : rims_[rim].planes) sum += sign * curves_[plane].dF[cell.piece[plane]] * rate[plane];
  return sum;
}

double PiecewiseJoint::rim_force(const Cell& cell, Index rim, const VectorXd& c) const {
  double sum = rim_rate(cell, rim, c);
  for (const auto& [plane, sign] : rims_[rim].planes) sum += sign * curves_[plane].F0[cell.piece[plane]];
  return sum;
}

}  // namespace fastjoint::stage3
