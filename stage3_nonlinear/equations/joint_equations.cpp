// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "common/matrices/inverse.hpp"

namespace fastjoint::stage3 {
namespace {

/// Replaces the stiffnesses of the plates themselves by reference stiffnesses K. They stay where S is nothing but
/// rounding beside them, as that of a plate held by one fastener alone.
void set_reference_stiffnesses(const MatrixXd& S, std::vector<Contact>& contacts) {
  constexpr double more = 1.05;
  constexpr double negligible = 1e-9, rounding = 1e-12;
  const VectorXd rows = more * S.cwiseAbs().rowwise().sum();
  const Index a = rows.size() / contacts.size();
  const double largest = rows.maxCoeff();
  for (Index j = 0; j < std::ssize(contacts); ++j) {
    if (largest <= rounding * contacts[j].stiffness) continue;
    const double row = rows.segment(j * a, a).maxCoeff();
    contacts[j].stiffness = row > negligible * largest ? row : largest;
  }
}

/// Stiffness of the softer of the two plates at its discs.
double plate_stiffness(const JointModel& joint, const ShearPlane& plane) {
  const auto at = [&](const HoleModel& hole) {
    return joint.plates[hole.plate].S.diagonal().segment(hole.disc, joint.n_directions()).maxCoeff();
  };
  const auto [softer, stiffer] = std::minmax({at(joint.first_hole(plane)), at(joint.second_hole(plane))});
  return softer > 0 ? softer : stiffer > 0 ? stiffer : 1.0;
}

MatrixXd metric_of(const MatrixXd& S, const std::vector<Contact>& contacts) {
  const Index a = S.rows() / contacts.size();
  MatrixXd W = -0.5 * (S + S.transpose());
  for (Index i = 0; i < W.rows(); ++i) W(i, i) += contacts[i / a].stiffness;
  return matrices::inverse_of_positive(std::move(W)).value();
}

/// Gives open and yielded fasteners a trace of stiffness in the Jacobian, not in the residual: without it the Jacobian
/// is singular where such fasteners alone hold a plate. The trace falls with the residual, so that the last steps are
/// quick also where springs as weak as the trace hold a plate (docs/theory.md, section 8.5).
void add_trace(const JointEquations& equations, double residual, ContactState& state) {
  constexpr double share = 1e-7;
  constexpr double least = 1e-11;  // rounding over this is still a small step
  const double trace = std::clamp(share * residual, least, share);
  for (Index j = 0; j < std::ssize(state.dF.along); ++j) {
    const double k = equations.contacts[j].stiffness;
    const auto add = [&](double& dF, double& ddelta) {
      if (std::abs(dF) >= trace) return;
      dF = trace;
      if (equations.metric.size() > 0) ddelta = (1 - trace) / k;
    };
    add(state.dF.along[j], state.ddelta.along[j]);
    add(state.dF.across[j], state.ddelta.across[j]);
  }
}

}  // namespace

JointEquations make_equations(const JointModel& joint) {
  std::vector<Contact> contacts;
  for (const auto& plane : joint.planes)
    contacts.push_back({plane.law, plane.clearance, plate_stiffness(joint, plane), plane.one_sided});
  return make_equations(condense(joint), std::move(contacts));
}

JointEquations make_equations(CondensedSystem system, std::vector<Contact> contacts) {
  constexpr double rounding = 1e-13;  // of what a plate that one fastener alone holds resists: nothing
  const VectorXd rows = system.S_ud.cwiseAbs().rowwise().sum();
  for (Index i = 0; i < std::ssize(rows); ++i) {
    const Index plane = i * std::ssize(contacts) / rows.size();
    if (rows[i] > rounding * contacts[plane].stiffness) continue;
    system.S_ud.row(i).setZero();
    system.S_ud.col(i).setZero();
  }
  set_reference_stiffnesses(system.S_ud, contacts);
  const bool rise = std::ranges::all_of(contacts, [](const Contact& each) { return each.law->rises(); });
  MatrixXd metric = rise ? metric_of(system.S_ud, contacts) : MatrixXd();
  return {std::move(system), std::move(contacts), std::move(metric)};
}

MatrixXd tangent(const CondensedSystem& system, const ContactState& state, bool friction) {
  MatrixXd F = MatrixXd::Identity(state.F.size(), state.F.size());
  if (friction && system.has_friction()) F += system.friction_matrix(state.F);
  return state.times(system.S_ud, state.ddelta) + state.times(F, state.dF);
}

MatrixXd hessian(const JointEquations& equations, const ContactState& state) {
  const Index a = equations.n_directions();
  MatrixXd H = equations.metric;
  for (Index j = 0; j < equations.n_planes(); ++j) {
    const auto e = state.direction.col(j);
    H.block(j * a, j * a, a, a).diagonal().array() -= state.ddelta.across[j];
    H.block(j * a, j * a, a, a) -= (state.ddelta.along[j] - state.ddelta.across[j]) * e * e.transpose();
  }
  return H;
}

RootProblem root_problem(const JointEquations& equations, double load_factor, double scale, const VectorXd* frozen) {
  const CondensedSystem& system = equations.system;
  VectorXd load = load_factor * system.q;
  if (frozen) load -= system.friction_forces(*frozen);
  const bool friction = system.has_friction() && !frozen;
  RootProblem problem;
  problem.residual = [&equations, load, scale, friction](const VectorXd& x) -> VectorXd {
    const auto state = contact_state(equations.contacts, scale * x);
    VectorXd r = state.F + equations.system.S_ud * state.delta - load;
    if (friction) r += equations.system.friction_forces(state.F);
    return r / scale;
  };
  const auto traced = [&equations, residual = problem.residual, scale](const VectorXd& x) {
    auto state = contact_state(equations.contacts, scale * x);
    add_trace(equations, residual(x).cwiseAbs().maxCoeff(), state);
    return state;
  };
  problem.jacobian = [&equations, traced, friction](const VectorXd& x) -> MatrixXd {
    return tangent(equations.system, traced(x), friction);
  };
  if (equations.metric.size() > 0 && !friction) {
    problem.gradient = [&metric = equations.metric](const VectorXd& r) -> VectorXd { return metric * r; };
    problem.hessian = [&equations, traced](const VectorXd& x) -> MatrixXd { return hessian(equations, traced(x)); };
  }
  return problem;
}

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
