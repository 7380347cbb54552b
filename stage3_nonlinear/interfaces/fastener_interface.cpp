// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/fastener_interface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fastjoint::stage3 {
namespace {

Branch branch(const Contact& contact, const VectorXd& c) {
  const double length = c.norm(), k = contact.stiffness;
  return contact.is_pulled_open(c) ? Branch::open(length, k) : contact.law->at(length, k, contact.clearance);
}

/// Matrix with one eigenvalue along e and another perpendicular to it.
MatrixXd along_and_across(const VectorXd& e, double along, double across) {
  MatrixXd A = (along - across) * e * e.transpose();
  A.diagonal().array() += across;
  return A;
}

std::vector<Corner> corners_of(const Contact& contact) {
  constexpr double equal = 1e-9;
  const Law& law = *contact.law;
  const double k = contact.stiffness;
  const double gap = law.gap(contact.clearance);
  std::vector<Corner> result;
  const auto corners = law.corners(k, contact.clearance);
  // The corners of a piecewise linear law include that of its gap.
  if (corners ? gap == 0 && contact.one_sided : gap > 0 || contact.one_sided)
    result.push_back({k * gap, CornerKind::contact});
  for (const double c : corners.value_or(std::vector<double>{})) {
    const double delta = law.at(c, k, contact.clearance).delta;
    const CornerKind kind = std::abs(delta - gap) <= equal * gap ? CornerKind::contact
                            : delta < gap                        ? CornerKind::slip
                                                                 : CornerKind::yield;
    result.push_back({c, kind});
  }
  return result;
}

}  // namespace

VectorXd along(const VectorXd& v) {
  const double length = v.norm();
  return length > 0 ? VectorXd(v / length) : VectorXd(VectorXd::Unit(v.size(), 0));
}

FastenerInterface::FastenerInterface(std::vector<Contact> planes, Place place)
    : planes_(std::move(planes)), place_(std::move(place)) {
  for (const Contact& plane : planes_) branches_.push_back(plane.law->branches(plane.clearance));
  for (const auto& hole : place_.friction_holes) {
    auto& sides = sides_.emplace_back();
    for (const Side side : {plus_side, minus_side}) {
      const auto& its = hole.sides[side];
      if (its.column < 0) continue;
      const double peak = place_.mu[hole.hole] / its.unit_force;
      sides[side] = {peak, its.resultant * peak, 1, its.across * peak};
    }
  }
  balance();
}

void FastenerInterface::balance() {
  for (Index i = 0; i < std::ssize(sides_); ++i)
    for (const Side side : {plus_side, minus_side}) {
      const auto& [hole, direction, cases, disc, other] = place_.friction_holes[i];
      double transferred = 1;
      for (Index of = 0; of < n_holes() && !place_.law_includes_friction; ++of)
        transferred += part_of_mean_ratio(of, hole, direction, side);
      HoleFriction& friction = sides_[i][side];
      const double change = transferred / (1 + friction.friction_ratio());
      for (double* each : {&friction.resultant, &friction.peak, &friction.bearing, &friction.across}) *each *= change;
    }
}

bool FastenerInterface::has_case(Index hole) const {
  return std::ranges::any_of(place_.friction_holes, [&](const FrictionHole& each) {
    return each.hole == hole && (each.sides[plus_side].column >= 0 || each.sides[minus_side].column >= 0);
  });
}

double FastenerInterface::part_of_mean_ratio(Index of, Index hole, Index direction, Side side) const {
  const Index at = friction_at(of, direction);
  if (at < 0) return 0;
  const auto& sides = sides_[at];
  const double n = double(n_holes());
  if (planes_.size() == 1) return sides[of == hole ? side : 1 - side].friction_ratio() / n;
  const auto bears =
      std::ranges::count_if(place_.friction_holes[at].sides, [](const auto& each) { return each.column >= 0; });
  return bears == 0 ? 0 : (sides[0].friction_ratio() + sides[1].friction_ratio()) / double(bears) / n;
}

double FastenerInterface::bearing(const VectorXd& F, Index hole, Index direction) const {
  const Index a = place_.n_directions;
  double force = 0;
  if (hole < std::ssize(planes_)) force -= F[hole * a + direction];
  if (hole > 0) force += F[(hole - 1) * a + direction];
  return force;
}

VectorXd FastenerInterface::friction(const VectorXd& F) const {
  VectorXd Lambda = VectorXd::Zero(place_.n_columns);
  for (Index i = 0; i < std::ssize(sides_); ++i) {
    const FrictionHole& hole = place_.friction_holes[i];
    const double b = bearing(F, hole.hole, hole.direction);
    const Side side = b < 0 ? minus_side : plus_side;
    const HoleFriction& friction = sides_[i][side];
    if (hole.sides[side].column >= 0) Lambda[hole.sides[side].column] = friction.peak * std::abs(b);
    Lambda[hole.disc] += (1 - friction.bearing) * b;
    if (hole.other_disc) Lambda[*hole.other_disc] += friction.across * std::abs(b);
  }
  return Lambda;
}

MatrixXd FastenerInterface::friction_by_force(const VectorXd& F) const {
  MatrixXd slopes = MatrixXd::Zero(place_.n_columns, F.size());
  const Index a = place_.n_directions;
  for (Index i = 0; i < std::ssize(sides_); ++i) {
    const FrictionHole& hole = place_.friction_holes[i];
    const bool minus = bearing(F, hole.hole, hole.direction) < 0;
    const HoleFriction& friction = sides_[i][minus ? minus_side : plus_side];
    const double sign = minus ? -1 : 1;
    for (const Index plane : {hole.hole - 1, hole.hole}) {
      if (plane < 0 || plane >= std::ssize(planes_)) continue;
      auto column = slopes.col(plane * a + hole.direction);
      const double by = plane == hole.hole ? -1 : 1;  // derivative of the bearing force by the force of the plane
      if (const Index at = hole.sides[minus ? minus_side : plus_side].column; at >= 0)
        column[at] += sign * by * friction.peak;
      column[hole.disc] += by * (1 - friction.bearing);
      if (hole.other_disc) column[*hole.other_disc] += sign * by * friction.across;
    }
  }
  return slopes;
}

std::vector<Slider> FastenerInterface::sliders(const History& history, Index plane) const {
  const Index a = place_.n_directions, n = std::ssize(branches_[plane]);
  if (history.empty()) return std::vector(n, Slider{PlaneVector::Zero(a), PlaneVector::Zero(a)});
  auto first = history.begin();
  for (Index j = 0; j < plane; ++j) first += std::ssize(branches_[j]);
  return {first, first + n};
}

std::optional<RememberedState> FastenerInterface::remembered_state(const VectorXd& c, const History& history,
                                                                   Index plane) const {
  if (branches_[plane].empty() || history.empty()) return std::nullopt;
  const auto before = sliders(history, plane);
  const auto at_rest = [](const Slider& slider) { return slider.set.isZero(0); };
  if (std::ranges::all_of(before, at_rest)) return std::nullopt;  // then the law's own curve holds
  const Index a = place_.n_directions;
  return state_from(before, c.segment(plane * a, a), plane);
}

RememberedState FastenerInterface::state_from(const std::vector<Slider>& before, const VectorXd& c, Index plane) const {
  const Contact& contact = planes_[plane];
  const double k = contact.stiffness;
  return remembered(branches_[plane], before, c, k, branch(contact, c).delta * along(c), contact.one_sided);
}

History FastenerInterface::commit(const VectorXd& c, const History& history) const {
  const Index a = place_.n_directions;
  History next;
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    if (branches_[j].empty()) continue;
    const auto of_plane = state_from(sliders(history, j), c.segment(j * a, a), j).sliders;
    next.insert(next.end(), of_plane.begin(), of_plane.end());
  }
  return next;
}

std::vector<PlaneMemory> FastenerInterface::memories(const History& history) const {
  std::vector<PlaneMemory> result;
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    PlaneMemory& memory = result.emplace_back(PlaneMemory{VectorXd::Zero(place_.n_directions), 0, {}, {}});
    const auto of_plane = sliders(history, j);
    for (std::size_t b = 0; b < of_plane.size(); ++b) {
      const bool is_slip = branches_[j][b].is_slip;
      if (!is_slip) memory.set = of_plane[b].set;
      (is_slip ? memory.slip : memory.yield) = of_plane[b].motion;
      memory.dissipated += of_plane[b].dissipated;
    }
  }
  return result;
}

Response FastenerInterface::respond(const VectorXd& c, const History& history) const {
  const Index n = c.size(), a = place_.n_directions;
  Response response{VectorXd(n), VectorXd(n), {}, MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), {}};
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    const VectorXd here = c.segment(j * a, a), e = along(here);
    const double length = here.norm();
    if (const auto state = remembered_state(c, history, j)) {
      response.F.segment(j * a, a) = state->F;
      response.delta.segment(j * a, a) = state->delta;
      response.dF.block(j * a, j * a, a, a) = state->dF;
      response.ddelta.block(j * a, j * a, a, a) = state->ddelta;
      continue;
    }
    const Branch on = branch(planes_[j], here);
    if (on.failed) response.failed = j * a;
    response.F.segment(j * a, a) = on.F * e;
    response.delta.segment(j * a, a) = on.delta * e;
    // The eigenvalues perpendicular to c are F / |c| and delta / |c|, or their limits at c = 0.
    response.dF.block(j * a, j * a, a, a) = along_and_across(e, on.dF, length > 0 ? on.F / length : on.dF);
    response.ddelta.block(j * a, j * a, a, a) =
        along_and_across(e, on.ddelta, length > 0 ? on.delta / length : on.ddelta);
  }
  response.Lambda = friction(response.F);
  response.dLambda = friction_by_force(response.F) * response.dF;
  return response;
}

/// Adds the small stiffness to open and yielded fasteners: without it the Jacobian is singular if a plate has no other
/// constraint.
void FastenerInterface::add_small_stiffness(double small, Response& response) const {
  const Index a = place_.n_directions;
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    auto dF = response.dF.block(j * a, j * a, a, a), ddelta = response.ddelta.block(j * a, j * a, a, a);
    const Contact& contact = planes_[j];
    const VectorXd e = along(response.delta.segment(j * a, a));
    const auto raise = [&](const VectorXd& direction) {
      const double slope = direction.dot(dF * direction);
      if (std::abs(slope) >= small) return;
      dF += (small - slope) * direction * direction.transpose();
      if (!contact.law->rises()) return;
      const double moved = (1 - small) / contact.stiffness - direction.dot(ddelta * direction);
      ddelta += moved * direction * direction.transpose();
    };
    raise(e);
    if (a > 1) raise(Eigen::Vector2d(-e[1], e[0]));
  }
}

std::vector<std::vector<Corner>> FastenerInterface::corners() const {
  std::vector<std::vector<Corner>> all;
  for (const Contact& plane : planes_) all.push_back(corners_of(plane));
  return all;
}

double FastenerInterface::position(const VectorXd& c, Index entry) const {
  const Index a = place_.n_directions;
  return a == 1 ? c[entry] : c.segment(entry * a, a).norm();
}

VectorXd FastenerInterface::slope(const VectorXd& c, Index entry) const {
  const Index a = place_.n_directions;
  VectorXd result = VectorXd::Zero(c.size());
  result.segment(entry * a, a) = a == 1 ? VectorXd::Ones(1) : VectorXd(c.segment(entry * a, a).normalized());
  return result;
}

VectorXd FastenerInterface::coordinates(const VectorXd& F) const {
  const Index a = place_.n_directions;
  VectorXd c = F;
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    const Contact& contact = planes_[j];
    const VectorXd here = F.segment(j * a, a);
    const double force = here.norm();
    if (force > 0 && !contact.is_pulled_open(here))
      c.segment(j * a, a) = along(here) * contact.law->coordinate(force, contact.stiffness, contact.clearance);
  }
  return c;
}

std::vector<Change> FastenerInterface::changes(const VectorXd& c, const Response& response) const {
  std::vector<Change> result;
  add_law_changes(c, friction_by_force(response.F), result);
  for (Index hole = 0; hole < n_holes(); ++hole)
    if (place_.mu[hole] > 0 && has_case(hole)) result.push_back(change_by_mu(hole, response.F));
  return result;
}

void FastenerInterface::add_law_changes(const VectorXd& c, const MatrixXd& by_force,
                                        std::vector<Change>& result) const {
  const Index a = place_.n_directions;
  for (Index j = 0; j < std::ssize(planes_); ++j) {
    const Contact& contact = planes_[j];
    const VectorXd here = c.segment(j * a, a), e = along(here);
    if (here.isZero(0) || contact.is_pulled_open(here)) continue;
    const auto slopes = contact.law->slopes(here.norm(), contact.stiffness, contact.clearance);
    for (Index i = 0; i < std::ssize(slopes); ++i) {
      VectorXd F = VectorXd::Zero(c.size()), delta = VectorXd::Zero(c.size());
      F.segment(j * a, a) = slopes[i].F * e;
      delta.segment(j * a, a) = slopes[i].delta * e;
      const NumberKind kind = i == 0 ? NumberKind::clearance : NumberKind::law;
      VectorXd Lambda = by_force.rows() > 0 ? VectorXd(by_force * F) : VectorXd();  // BLAS refuses no rows
      result.push_back(
          {kind, place_.first_plane + j, std::max<Index>(i - 1, 0), std::move(F), std::move(delta), std::move(Lambda)});
    }
  }
}

/// Differentiates the logarithms of the bearing forces: friction in one hole changes those of all holes of a fastener.
Change FastenerInterface::change_by_mu(Index hole, const VectorXd& F) const {
  const VectorXd none = VectorXd::Zero(F.size());
  Change change{NumberKind::mu, place_.first_hole + hole, 0, none, none, VectorXd::Zero(place_.n_columns)};
  const double mu = place_.mu[hole];
  for (Index i = 0; i < std::ssize(sides_); ++i) {
    const FrictionHole& its = place_.friction_holes[i];
    const double b = bearing(F, its.hole, its.direction);
    const Side side = b < 0 ? minus_side : plus_side;
    const HoleFriction& friction = sides_[i][side];
    const double transferred = friction.bearing + friction.resultant;
    double relative = its.hole == hole ? -friction.resultant / transferred / mu : 0;  // d ln bearing / d mu
    if (!place_.law_includes_friction)
      relative += part_of_mean_ratio(hole, its.hole, its.direction, side) / transferred / mu;
    const double rises = relative + (its.hole == hole ? 1 / mu : 0);
    if (its.sides[side].column >= 0) change.Lambda[its.sides[side].column] += rises * friction.peak * std::abs(b);
    change.Lambda[its.disc] -= relative * friction.bearing * b;
    if (its.other_disc) change.Lambda[*its.other_disc] += rises * friction.across * std::abs(b);
  }
  return change;
}

VectorXd FastenerInterface::transferred(const VectorXd& F, Index side) const {
  const Index a = place_.n_directions;
  VectorXd result = F;
  for (Index j = 0; j < std::ssize(planes_); ++j)
    for (Index d = 0; d < a; ++d) {
      const Index hole = std::min(j + side, n_holes() - 1);  // the force on the ground is that of the last hole
      const Index at = friction_at(hole, d);
      if (at < 0) continue;
      const HoleFriction& friction = sides_[at][bearing(F, hole, d) < 0 ? minus_side : plus_side];
      result[j * a + d] *= friction.bearing + friction.resultant;
    }
  return result;
}

}  // namespace fastjoint::stage3
