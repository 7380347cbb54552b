// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/linear_joint.hpp"

#include <Eigen/LU>

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

LinearForces linear_forces(const CondensedSystem& system, const VectorXd& flexibility, double load_factor) {
  constexpr int most_tries = 8;
  MatrixXd A = system.S_ud * flexibility.asDiagonal();
  A.diagonal().array() += 1;
  const VectorXd rhs = load_factor * system.q;
  LinearForces result{A.partialPivLu().solve(rhs), 1, !system.has_friction()};
  while (!result.consistent && result.solves < most_tries) {
    const VectorXd before = system.E * result.F;
    result.F = (A + system.friction_matrix(result.F)).partialPivLu().solve(rhs);
    result.consistent = ((system.E * result.F).array() * before.array() >= 0).all();
    ++result.solves;
  }
  return result;
}

std::optional<VectorXd> linear_flexibility(const JointEquations& equations) {
  const Index n = equations.n_planes(), a = equations.n_directions();
  VectorXd flexibility(n * a);
  for (Index j = 0; j < n; ++j) {
    const Contact& contact = equations.contacts[j];
    const auto kinks = contact.law->kinks(contact.stiffness, contact.clearance);
    if (!kinks || !kinks->empty() || contact.one_sided) return std::nullopt;
    const Branch on = contact.law->at(1, contact.stiffness, contact.clearance);
    if (!(on.dF > 0)) return std::nullopt;
    flexibility.segment(j * a, a).setConstant(on.ddelta / on.dF);
  }
  return flexibility;
}

}  // namespace fastjoint::stage3
