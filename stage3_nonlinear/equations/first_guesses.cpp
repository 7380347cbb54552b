// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/first_guesses.hpp"

#include "stage3_nonlinear/equations/tangent_factor.hpp"

namespace fastjoint::stage3 {

LinearForces linear_forces(const JointEquations& equations, const VectorXd& flexibility, double load_factor) {
  constexpr int max_tries = 8;
  MatrixXd A = equations.system->S_ud * flexibility.asDiagonal();
  A.diagonal().array() += 1;
  const VectorXd rhs = equations.rigid_forces(load_factor);
  LinearForces result{TangentFactor(A, equations.system->rim_sizes).solve(rhs), !equations.has_cosine_friction};
  for (int i = 1; i < max_tries && !result.consistent; ++i) {
    const MatrixXd friction = equations.friction_matrix(result.F);
    result.F = TangentFactor(A + friction, equations.system->rim_sizes).solve(rhs);
    result.consistent = equations.friction_matrix(result.F) == friction;
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
