// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/first_guesses.hpp"

#include "stage3_nonlinear/equations/tangent_factor.hpp"

namespace fastjoint::stage3 {

LinearForces linear_forces(const JointEquations& equations, const VectorXd& flexibility, double load_factor) {
  constexpr int max_tries = 8;
  const VectorXd rhs = equations.rigid_forces(load_factor);
  ContactState state = contact_state(equations, VectorXd::Zero(rhs.size()));
  for (PlacedResponse& part : state.parts) {
    const Index n = part.F.size();
    part.dF.setIdentity(n, n);
    part.ddelta = flexibility.segment(part.row, n).asDiagonal();
    part.dLambda.resize(0, n);
  }
  LinearForces result{TangentFactor(*equations.system, state).solve(rhs), !equations.has_cosine_friction};
  for (int i = 1; i < max_tries && !result.consistent; ++i) {
    bool same = true;
    for (std::size_t at = 0; at < state.parts.size(); ++at) {
      PlacedResponse& part = state.parts[at];
      MatrixXd by_force =
          equations.interfaces[at].interface->friction_by_force(result.F.segment(part.row, part.F.size()));
      same = same && by_force.rows() == part.dLambda.rows() && by_force == part.dLambda;
      part.dLambda = std::move(by_force);
    }
    result.consistent = same;
    if (!same) result.F = TangentFactor(*equations.system, state).solve(rhs);
  }
  return result;
}

VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  const Index n = equations.n_plane_rows();
  VectorXd flexibility = VectorXd::Zero(equations.n_unknowns());
  Index row = n;
  for (const auto& rim : equations.rims) {
    flexibility.segment(row, rim->n_long()).setConstant(1 / rim->contact().stiffness());
    row += rim->n_long();
  }
  if (initial.guess == Guess::linear) {
    const double K = initial.stiffness.value_or(equations.system->S_ud.diagonal().head(n).mean());
    flexibility.head(n).setConstant(K > 0 ? 1 / K : 0);
  }
  VectorXd F = linear_forces(equations, flexibility, load_factor).F;
  if (initial.guess != Guess::equal) return F;
  const VectorXd mean = F.head(n).reshaped(equations.n_directions(), equations.n_planes()).rowwise().mean();
  F.head(n) = mean.replicate(equations.n_planes(), 1);
  return F;
}

VectorXd guessed_coordinates(const JointEquations& equations, const VectorXd& F) {
  VectorXd c(F.size());
  for (const auto& [interface, row, friction] : equations.interfaces)
    c.segment(row, interface->size()) = interface->coordinates(F.segment(row, interface->size()));
  return c;
}

std::vector<InitialScene> guesses_in_order(const InitialScene& initial) {
  std::vector<InitialScene> order{initial};
  for (const Guess guess : {Guess::linear, Guess::rigid, Guess::equal})
    if (guess != initial.guess) order.push_back({guess, std::nullopt});
  return order;
}

VectorXd first_guess(const JointEquations& equations, const InitialScene& guess, double load_factor) {
  return guessed_coordinates(equations, guessed_forces(equations, guess, load_factor));
}

}  // namespace fastjoint::stage3
