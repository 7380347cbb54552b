// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/first_guess.hpp"

#include "stage3_nonlinear/equations/linear_joint.hpp"

namespace fastjoint::stage3 {

using Eigen::VectorXd;

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
  guesses.reserve(order.size());
  for (const auto& each : order)
    guesses.push_back(contact_coordinates(equations.contacts, guessed_forces(equations, each, load_factor)));
  return guesses;
}

}  // namespace fastjoint::stage3
