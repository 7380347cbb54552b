// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/rim_interface.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace fastjoint::stage3 {
namespace {

/// Sign of the depth in the position of an entry.
double sign_of(Index entry) { return entry == 0 ? 1 : -1; }

}  // namespace

Response RimInterface::respond(const VectorXd& c, const History& /*history*/) const {
  const Index n = size(), t = n_friction();
  const CompressionOnlyRim& contact = rim_->contact();
  if (!c.allFinite()) {
    const VectorXd none = VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
    return {none, none, VectorXd::Zero(t), MatrixXd::Identity(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(t, n)};
  }
  const RimSolution& its = rim_->solve(c);
  Response response{its.forces.head(n), {}, VectorXd::Zero(t), {}, {}, MatrixXd::Zero(t, n)};
  if (!its.converged) response.F.setConstant(std::numeric_limits<double>::quiet_NaN());
  response.delta = (c - response.F) / rim_->k();
  response.dF = contact.stiffness() * its.touching.gram.topRows(n) * its.w_by_c;
  if (t > 0 && contact.mu() > 0) {
    response.Lambda = its.friction.forces.head(t) / rim_->area();
    response.dLambda = contact.stiffness() / rim_->area() * its.friction.slopes.topRows(t) * its.w_by_c;
  } else {
    response.dF = (0.5 * (response.dF + response.dF.transpose())).eval();
  }
  response.ddelta = (MatrixXd::Identity(n, n) - response.dF) / rim_->k();
  return response;
}

void RimInterface::add_small_stiffness(double small, Response& response) const {
  response.ddelta *= 1 - small;
  response.dF *= 1 - small;
  response.dF.diagonal().array() += small;
}

/// The position of a bolt with clearance that carries no load is indeterminate, so that a small force must be exceeded
/// for contact.
std::vector<std::vector<Corner>> RimInterface::corners() const {
  constexpr double min_depth = 1e-6;  // of the gap
  const CompressionOnlyRim& contact = rim_->contact();
  return {{{min_depth * contact.stiffness() * std::max(contact.gap(), 0.0), CornerKind::touch}},
          {{0, CornerKind::part}}};
}

/// The largest depth of the disc, or minus the smallest, times the stiffness.
double RimInterface::position(const VectorXd& c, Index entry) const {
  const CompressionOnlyRim& contact = rim_->contact();
  const double sign = sign_of(entry);
  const VectorXd& w = rim_->solve(c).w;
  return sign * contact.stiffness() * contact.depth(w, contact.deepest(w, sign));
}

/// At an extremum the derivative by the angle is zero.
VectorXd RimInterface::slope(const VectorXd& c, Index entry) const {
  const CompressionOnlyRim& contact = rim_->contact();
  const double sign = sign_of(entry);
  const RimSolution& its = rim_->solve(c);
  return sign * contact.stiffness() * its.w_by_c.transpose() * contact.pressures().at(contact.deepest(its.w, sign));
}

/// Shears are proportional to the coefficient if the rim slips, and independent of it if the rim sticks. The gap enters
/// like a constant displacement, which is the first wave.
std::vector<Change> RimInterface::changes(const VectorXd& c, const Response& response) const {
  const double k = rim_->k();
  std::vector<Change> result{
      {NumberKind::gap, at_, 0, -k * response.dF.col(0), response.dF.col(0), -k * response.dLambda.col(0)}};
  const CompressionOnlyRim& contact = rim_->contact();
  if (n_friction() == 0 || contact.mu() == 0) return result;
  const RimSolution& its = rim_->solve(c);
  const VectorXd none = VectorXd::Zero(size());
  Change by_mu{NumberKind::rim_mu, at_, 0, none, none, VectorXd::Zero(n_friction())};
  if (its.friction.slips) {
    by_mu.F = contact.stiffness() * its.touching.gram.topRows(size()) * its.w_by_mu;
    by_mu.delta = -by_mu.F / k;
    by_mu.Lambda = response.Lambda / contact.mu() +
                   contact.stiffness() / rim_->area() * its.friction.slopes.topRows(n_friction()) * its.w_by_mu;
  }
  result.push_back(std::move(by_mu));
  return result;
}

}  // namespace fastjoint::stage3
