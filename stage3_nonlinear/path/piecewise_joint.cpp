// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/exact_path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace fastjoint::stage3 {
namespace {

using Eigen::PartialPivLU;

/// Corners of a plane over all of c, ascending.
/// @param zero True if c = 0 counts as a corner.
std::vector<double> corners(const Contact& contact, bool zero) {
  auto result = contact.law->corners(contact.stiffness, contact.clearance).value_or(std::vector<double>{});
  if (!contact.one_sided)
    for (Index i = result.size(); i-- > 0;) result.push_back(-result[i]);
  if (zero) result.push_back(0);
  std::sort(result.begin(), result.end());
  return result;
}

/// Distance to a point inside the first or last piece: as far out again as its corner is, so that no unit of force
/// loses digits.
double outward(double corner) { return corner != 0 ? std::abs(corner) : 1.0; }

CornerCurve make_curve(const Contact& contact, bool friction) {
  const bool bears_at_once = contact.law->at(0, contact.stiffness, contact.clearance).dF > 0;
  CornerCurve curve{corners(contact, friction || (contact.one_sided && bears_at_once)), {}};
  const auto& at = curve.corners;
  for (Index i = 0; i <= std::ssize(at); ++i) {
    const double low = i == 0 ? (at.empty() ? 0 : at[0] - outward(at[0])) : at[i - 1];
    const double high = i == std::ssize(at) ? low + outward(low) : at[i];
    const double c = 0.5 * (low + high);
    const double near = c < 0 ? high : low;  // a law that yields far out loses no digits of its offset there
    const auto inside = contact_state({contact}, VectorXd::Constant(1, c));
    const auto state = contact_state({contact}, VectorXd::Constant(1, near));
    const double dF = inside.dF.along[0], ddelta = inside.ddelta.along[0];
    curve.pieces.push_back({state.F[0] - dF * near, dF, state.delta[0] - ddelta * near, ddelta, c < 0 ? -1 : 1});
  }
  return curve;
}

}  // namespace

bool is_piecewise_linear(const JointEquations& equations) {
  return equations.n_directions() == 1 && equations.rims.empty() &&
         std::ranges::all_of(equations.contacts, [](const Contact& each) {
           return each.law->corners(each.stiffness, each.clearance).has_value();
         });
}

PiecewiseJoint::PiecewiseJoint(const JointEquations& equations) : system_(&equations.system) {
  assert(is_piecewise_linear(equations));
  std::vector<bool> alone(equations.contacts.size(), false);
  for (Index at = 0; at < system_->E.rows(); ++at) {
    Rim& rim = rims_.emplace_back();
    for (Index plane = 0; plane < system_->E.cols(); ++plane)
      if (const double sign = system_->E(at, plane); sign != 0) rim.emplace_back(plane, sign);
    if (rim.size() > 1) {
      shared_rims_.push_back(at);
    } else {
      alone[rim[0].first] = true;
    }
  }
  for (Index j = 0; j < std::ssize(alone); ++j) curves_.push_back(make_curve(equations.contacts[j], alone[j]));
}

Cell PiecewiseJoint::start() const {
  Cell cell;
  for (const auto& [corners, pieces] : curves_)
    cell.piece.push_back(std::upper_bound(corners.begin(), corners.end(), 0) - corners.begin());
  cell.side.assign(rims_.size(), 1);
  follow_signs(cell);
  return cell;
}

void PiecewiseJoint::follow_signs(Cell& cell) const {
  for (Index at = 0; at < std::ssize(rims_); ++at) {
    if (rims_[at].size() > 1) continue;
    const auto& [plane, sign] = rims_[at][0];
    cell.side[at] = sign > 0 ? piece(cell, plane).sign : -piece(cell, plane).sign;
  }
}

CellColumn PiecewiseJoint::column(const Cell& cell, Index plane) const {
  VectorXd by_force = VectorXd::Unit(std::ssize(curves_), plane);
  for (Index at = 0; at < std::ssize(rims_); ++at)
    if (const double sign = system_->E(at, plane); sign != 0) by_force += sign * friction(cell, at);
  const auto& [F0, dF, delta0, ddelta, sign] = piece(cell, plane);
  const auto by_delta = system_->S_ud.col(plane);
  CellColumn column(by_force.size(), 2);
  column << ddelta * by_delta + dF * by_force, delta0 * by_delta + F0 * by_force;
  return column;
}

CellEquations PiecewiseJoint::equations(const Cell& cell) const {
  const Index n = curves_.size();
  CellEquations result{MatrixXd(n, n), VectorXd::Zero(n)};
  for (Index j = 0; j < n; ++j) {
    const CellColumn column = this->column(cell, j);
    result.J.col(j) = column.col(0);
    result.offset += column.col(1);
  }
  return result;
}

std::vector<Index> PiecewiseJoint::changed(const Cell& from, const Cell& to) const {
  std::set<Index> planes;
  for (Index j = 0; j < std::ssize(curves_); ++j)
    if (from.piece[j] != to.piece[j]) planes.insert(j);
  for (Index at = 0; at < std::ssize(rims_); ++at)
    if (from.side[at] != to.side[at])
      for (const auto& [plane, sign] : rims_[at]) planes.insert(plane);
  return {planes.begin(), planes.end()};
}

VectorXd PiecewiseJoint::forces(const Cell& cell, const VectorXd& c, double share) const {
  const Index n = curves_.size();
  VectorXd F(n), delta(n);
  for (Index j = 0; j < n; ++j) {
    const CurvePiece& at = piece(cell, j);
    F[j] = share * at.F0 + at.dF * c[j];
    delta[j] = share * at.delta0 + at.ddelta * c[j];
  }
  VectorXd sum = F + system_->S_ud * delta;
  for (Index at = 0; at < std::ssize(rims_); ++at)
    for (const auto& [plane, sign] : rims_[at]) sum += sign * F[plane] * friction(cell, at);
  return sum;
}

double PiecewiseJoint::rim_force(const Cell& cell, Index rim, const VectorXd& c, double share) const {
  double sum = 0;
  for (const auto& [plane, sign] : rims_[rim])
    sum += sign * (share * piece(cell, plane).F0 + piece(cell, plane).dF * c[plane]);
  return sum;
}

std::optional<Line> CellLines::in(const Cell& cell) {
  constexpr double singular = 1e-13;
  if (auto line = base_ ? from_base(cell) : std::nullopt) return line;
  const auto [J, offset] = joint_.equations(cell);
  PartialPivLU<MatrixXd> lu(J);
  ++n_factors_;
  const double stretch = least_stretch(lu, J);
  if (!(stretch > singular)) return std::nullopt;
  Line line{lu.solve(-offset), lu.solve(q_)};
  base_ = Base{cell, std::move(lu), stretch, std::move(line), {}};
  return base_->line;
}

std::optional<Line> CellLines::from_base(const Cell& cell) {
  constexpr Index most_changed = 8;      // columns of so many: below, a new factor takes no longer
  constexpr double surely_held = 1e-10;  // bound of least_stretch
  constexpr double rounding = 1e-12;     // of the largest entry of a line, out of balance
  const auto planes = joint_.changed(base_->cell, cell);
  const Index m = planes.size();
  if (most_changed * m > q_.size()) return std::nullopt;
  Line line = base_->line;
  if (m == 0) return line;
  MatrixXd Y(q_.size(), m);
  for (Index i = 0; i < m; ++i) {
    auto& [column, solution] = base_->changes[planes[i]];
    if (CellColumn now = joint_.column(cell, planes[i]); column.size() == 0 || column != now) {
      column = std::move(now);
      solution = base_->lu.solve(column - joint_.column(base_->cell, planes[i]));
    }
    Y.col(i) = solution.col(0);
    line.offset -= solution.col(1);
  }
  MatrixXd small = Y(planes, Eigen::all);
  small.diagonal().array() += 1;
  const PartialPivLU<MatrixXd> lu(small);
  const double stretch = least_stretch(lu, small);
  if (!(base_->stretch * stretch > surely_held * (stretch + Y.cwiseAbs().colwise().sum().maxCoeff())))
    return std::nullopt;
  for (VectorXd* x : {&line.offset, &line.rate}) *x -= Y * lu.solve((*x)(planes));
  const auto balances = [&](const VectorXd& forces, const VectorXd& x) {
    return forces.cwiseAbs().maxCoeff() <= rounding * x.cwiseAbs().maxCoeff();
  };
  if (!balances(joint_.forces(cell, line.offset, 1), line.offset) ||
      !balances(joint_.forces(cell, line.rate, 0) - q_, line.rate))
    return std::nullopt;
  return line;
}

}  // namespace fastjoint::stage3
