// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stage3_nonlinear/exact_path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "tests/stage3_nonlinear/hand_made.hpp"

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
    const auto inside = test::state_of({contact}, VectorXd::Constant(1, c));
    const auto state = test::state_of({contact}, VectorXd::Constant(1, near));
    const double dF = inside.along(&Response::dF, 0), ddelta = inside.along(&Response::ddelta, 0);
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

PiecewiseJoint::PiecewiseJoint(const JointEquations& equations) : system_(equations.system.get()) {
  assert(is_piecewise_linear(equations));
  std::vector<bool> alone(equations.contacts.size(), false);
  const auto& layout = system_->friction.friction_holes;
  for (std::size_t fastener = 0; fastener < layout.size(); ++fastener)
    for (const FrictionHole& hole : layout[fastener]) {
      const auto& [interface, row, friction] = equations.interfaces[fastener];
      Rim& rim = rims_.emplace_back();
      if (hole.hole > 0) rim.emplace_back(row + hole.hole - 1, 1);
      if (hole.hole < interface->size()) rim.emplace_back(row + hole.hole, -1);
      const auto [plane, sign] = rim[0];
      for (const double side : {1.0, -1.0}) {
        VectorXd F = VectorXd::Zero(interface->size());
        F[plane - row] = side * sign;
        const VectorXd all = interface->friction_by_force(F).col(plane - row) / sign;
        VectorXd its = VectorXd::Zero(all.size());  // what this hole alone does
        for (const Index at : {hole.sides[plus_side].column, hole.sides[minus_side].column, hole.disc})
          if (at >= 0) its[at] = all[at];
        MatrixXd& H = side > 0 ? H_plus_ : H_minus_;
        H.conservativeResize(system_->H.rows(), H.cols() + 1);
        H.rightCols(1) = system_->H.middleCols(friction, all.size()) * its;
      }
      if (rim.size() > 1) {
        shared_rims_.push_back(std::ssize(rims_) - 1);
      } else {
        alone[plane] = true;
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

CellEquations PiecewiseJoint::equations(const Cell& cell) const {
  const Index n = curves_.size();
  CellEquations result{MatrixXd(n, n), VectorXd::Zero(n)};
  for (Index j = 0; j < n; ++j) {
    VectorXd by_force = VectorXd::Unit(n, j);
    for (Index at = 0; at < std::ssize(rims_); ++at)
      for (const auto& [plane, of_plane] : rims_[at])
        if (plane == j) by_force += of_plane * friction(cell, at);
    const auto& [F0, dF, delta0, ddelta, sign] = piece(cell, j);
    const auto by_delta = system_->S_ud.col(j);
    result.J.col(j) = ddelta * by_delta + dF * by_force;
    result.offset += delta0 * by_delta + F0 * by_force;
  }
  return result;
}

double PiecewiseJoint::rim_force(const Cell& cell, Index rim, const VectorXd& c, double share) const {
  double sum = 0;
  for (const auto& [plane, sign] : rims_[rim])
    sum += sign * (share * piece(cell, plane).F0 + piece(cell, plane).dF * c[plane]);
  return sum;
}

}  // namespace fastjoint::stage3
