// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/rim_interface.hpp"

#include <algorithm>
#include <utility>

#include "stage3_nonlinear/interfaces/rim_friction.hpp"

namespace fastjoint::stage3 {
namespace {

/// Sign of the depth in the position of an entry.
double sign_of(Index entry) { return entry == 0 ? 1 : -1; }

}  // namespace

Response RimInterface::respond(const VectorXd& c, const History& /*history*/) const {
  const Index n = c.size(), t = n_friction();
  const double k = rim_.stiffness();
  const VectorXd m = c / k;
  Touching touching = rim_.touching(m);
  Response response{rim_.forces(touching, m), m, VectorXd::Zero(t), {}, MatrixXd::Identity(n, n) / k, {}};
  response.dLambda = MatrixXd::Zero(t, n);
  if (t > 0 && rim_.mu() > 0) {
    const RimFriction friction = rim_friction(rim_, touching, m);
    response.Lambda = friction.forces / area_;
    response.dLambda = friction.slopes / area_;
  }
  response.dF = std::move(touching.share);
  return response;
}

/// A loose bolt lies anywhere, and touches where it presses by more than the little force that a solution leaves.
std::vector<std::vector<Corner>> RimInterface::corners() const {
  constexpr double little = 1e-6;  // of the gap
  return {{{little * rim_.stiffness() * std::max(rim_.gap(), 0.0), CornerKind::touch}}, {{0, CornerKind::part}}};
}

/// The depth of the disc where it is largest, or minus that where it is least, times the stiffness.
double RimInterface::position(const VectorXd& c, Index entry) const {
  return slope(c, entry).dot(c) - sign_of(entry) * rim_.stiffness() * rim_.gap();
}

/// The place of an extremum moves along the rim without changing it.
VectorXd RimInterface::slope(const VectorXd& c, Index entry) const {
  return sign_of(entry) * rim_.pressures().at(rim_.deepest(c, sign_of(entry)));
}

/// Shears are proportional to the coefficient where the rim slips, and do not know it where it sticks. The gap acts as
/// the first moment does, but for that moment itself.
std::vector<Change> RimInterface::changes(const VectorXd& c, const Response& response) const {
  const VectorXd none = VectorXd::Zero(c.size());
  std::vector<Change> result{{NumberKind::gap, at_, 0, -rim_.stiffness() * response.dF.col(0), none,
                              -rim_.stiffness() * response.dLambda.col(0)}};
  if (n_friction() == 0 || rim_.mu() == 0) return result;
  const VectorXd m = c / rim_.stiffness();
  Change by_mu{NumberKind::rim_mu, at_, 0, none, none, VectorXd::Zero(n_friction())};
  if (rim_friction(rim_, rim_.touching(m), m).slips) by_mu.Lambda = response.Lambda / rim_.mu();
  result.push_back(std::move(by_mu));
  return result;
}

}  // namespace fastjoint::stage3
