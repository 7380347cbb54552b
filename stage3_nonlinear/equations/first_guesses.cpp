// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/first_guesses.hpp"

#include "stage3_nonlinear/equations/tangent_factor.hpp"

namespace fastjoint::stage3 {

LinearForces linear_forces(const JointEquations& equations, const VectorXd& flexibility, double load_factor) {
  constexpr int max_tries = 8;
  const auto rims = equations.rim_sizes();
  MatrixXd A = equations.system->S_ud * flexibility.asDiagonal();
  A.diagonal().array() += 1;
  const VectorXd rhs = equations.rigid_forces(load_factor);
  LinearForces result{TangentFactor(A, rims).solve(rhs), 1, !equations.has_cosine_friction};
  while (!result.consistent && result.solves < max_tries) {
    const MatrixXd friction = equations.friction_matrix(result.F);
    result.F = TangentFactor(A + friction, rims).solve(rhs);
    result.consistent = equations.friction_matrix(result.F) == friction;
    ++result.solves;
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
    return linear_forces(equations, flexibility, load_factor).F;
  }
  VectorXd rigid = linear_forces(equations, flexibility, load_factor).F;
  if (initial.guess == Guess::rigid) return rigid;
  const VectorXd mean = rigid.head(n).reshaped(equations.n_directions(), equations.n_planes()).rowwise().mean();
  rigid.head(n) = mean.replicate(equations.n_planes(), 1);
  return rigid;
}

VectorXd guessed_coordinates(const JointEquations& equations, const VectorXd& F) {
  VectorXd c(F.size());
  for (const auto& [interface, row, friction] : equations.interfaces)
    c.segment(row, interface->size()) = interface->coordinates(F.segment(row, interface->size()));
  return c;
}

std::vector<VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  std::vector<InitialScene> order{initial};
  for (const Guess guess : {Guess::linear, Guess::rigid, Guess::equal})
    if (guess != initial.guess) order.push_back({guess, std::nullopt});
  std::vector<VectorXd> guesses;
  for (const auto& each : order)
    guesses.push_back(guessed_coordinates(equations, guessed_forces(equations, each, load_factor)));
  return guesses;
}

}  // namespace fastjoint::stage3
