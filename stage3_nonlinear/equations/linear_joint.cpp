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
    const auto corners = contact.law->corners(contact.stiffness, contact.clearance);
    if (!corners || !corners->empty() || contact.one_sided) return std::nullopt;
    const Branch on = contact.law->at(1, contact.stiffness, contact.clearance);
    if (!(on.dF > 0)) return std::nullopt;
    flexibility.segment(j * a, a).setConstant(on.ddelta / on.dF);
  }
  return flexibility;
}

VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  const CondensedSystem& system = equations.system;
  const auto rows = system.q.size();
  if (initial.guess == Guess::linear) {
    const double mean = system.S_ud.diagonal().mean();
    const double K = initial.stiffness.value_or(mean);
    const double flexibility = K > 0 ? 1 / K : 0;
    return linear_forces(system, VectorXd::Constant(rows, flexibility), load_factor).F;
  }
  VectorXd rigid = linear_forces(system, VectorXd::Zero(rows), load_factor).F;
  if (initial.guess == Guess::rigid) return rigid;
  const VectorXd mean = rigid.reshaped(equations.n_directions(), equations.n_planes()).rowwise().mean();
  return mean.replicate(equations.n_planes(), 1);
}

std::vector<VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  std::vector<InitialScene> order{initial};
  for (const Guess guess : {Guess::linear, Guess::rigid, Guess::equal})
    if (guess != initial.guess) order.push_back({guess, std::nullopt});
  std::vector<VectorXd> guesses;
  for (const auto& each : order)
    guesses.push_back(contact_coordinates(equations.contacts, guessed_forces(equations, each, load_factor)));
  return guesses;
}

}  // namespace fastjoint::stage3
