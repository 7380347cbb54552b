// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/first_guess.hpp"

#include "stage3_nonlinear/linear_joint.hpp"

namespace fastjoint::stage3 {

using Eigen::VectorXd;

VectorXd guessed_forces(const CondensedSystem& system, const InitialScene& initial, double load_factor) {
  const auto n = system.q.size();
  if (initial.guess == Guess::linear) {
    const double mean = system.S_ud.diagonal().mean();
    const double K = initial.stiffness.value_or(mean);
    const double flexibility = K > 0 ? 1 / K : 0;
    return linear_forces(system, VectorXd::Constant(n, flexibility), load_factor).F;
  }
  const VectorXd rigid = linear_forces(system, VectorXd::Zero(n), load_factor).F;
  return initial.guess == Guess::rigid ? rigid : VectorXd::Constant(n, rigid.mean());
}

std::vector<VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  std::vector<InitialScene> order{initial};
  for (const Guess guess : {Guess::linear, Guess::rigid, Guess::equal})
    if (guess != initial.guess) order.push_back({guess, std::nullopt});
  std::vector<VectorXd> guesses;
  guesses.reserve(order.size());
  for (const auto& each : order)
    guesses.push_back(contact_coordinates(equations.contacts, guessed_forces(equations.system, each, load_factor)));
  return guesses;
}

}  // namespace fastjoint::stage3
