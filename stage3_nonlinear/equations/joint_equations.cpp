// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/matrices/decompositions.hpp"
#include "stage3_nonlinear/equations/rim_friction.hpp"
#include "stage3_nonlinear/equations/tangent_factor.hpp"

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

/// Stiffness of the softer of the plane's plates at its discs.
double plate_stiffness(const JointModel& joint, const ShearPlane& plane) {
  const auto at = [&](const HoleModel& hole) {
    return joint.plates[hole.plate].S.diagonal().segment(hole.disc, joint.n_directions()).maxCoeff();
  };
  const auto [softer, stiffer] = std::minmax({at(joint.holes(plane).front()), at(joint.holes(plane).back())});
  return softer > 0 ? softer : stiffer > 0 ? stiffer : 1.0;
}

/// Rims of contact of all plates, plate after plate, each with the gap of the fastener in it.
std::vector<RimContact> rims_of(const JointModel& joint) {
  std::vector<RimContact> rims;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (const auto& rim : joint.plates[i].contact)
      rims.emplace_back(rim.pressures, rim.modulus * rim.area, joint.gap(i, rim.hole), joint.mu(i, rim.hole));
  return rims;
}

/// W^-1.
MatrixXd metric_of(const MatrixXd& S, const std::vector<Contact>& contacts) {
  const Index n = S.rows(), a = n / std::ssize(contacts);
  MatrixXd W = -0.5 * (S + S.transpose());
  for (Index i = 0; i < n; ++i) W(i, i) += contacts[i / a].stiffness;
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
  for (auto& rim : state.dF.rims) rim.diagonal().array() += trace;
}

/// Adds the shears of a rim of contact.
void add_friction(const RimContact& rim, const Touching& at, const VectorXd& m, ContactState& state) {
  state.dshear.emplace_back(MatrixXd::Zero(0, rim.size()));
  if (rim.mu() == 0) return;
  RimFriction friction = rim_friction(rim, at, m);
  VectorXd shear(state.shear.size() + friction.forces.size());
  shear << state.shear, friction.forces;
  state.shear = std::move(shear);
  state.dshear.back() = std::move(friction.slopes);
}

}  // namespace

JointEquations make_equations(const JointModel& joint) {
  std::vector<Contact> contacts;
  for (const auto& plane : joint.planes)
    contacts.push_back({plane.law, plane.clearance, plate_stiffness(joint, plane), plane.one_sided});
  return make_equations(condense(joint), std::move(contacts), rims_of(joint));
}

JointEquations make_equations(CondensedSystem system, std::vector<Contact> contacts, std::vector<RimContact> rims) {
  constexpr double rounding = 1e-13;  // of what a plate that one fastener alone holds resists: nothing
  JointEquations equations{std::move(system), std::move(contacts), {}, std::move(rims)};
  MatrixXd& S = equations.system.S_ud;
  const Index n = equations.n_plane_rows(), a = equations.n_directions();
  const VectorXd rows = S.topRows(n).cwiseAbs().rowwise().sum();
  for (Index i = 0; i < n; ++i) {
    if (rows[i] > rounding * equations.contacts[i / a].stiffness) continue;
    S.row(i).setZero();
    S.col(i).setZero();
  }
  set_reference_stiffnesses(S.topLeftCorner(n, n), equations.contacts);
  if (std::ranges::all_of(equations.contacts, [](const Contact& each) { return each.law->rises(); }))
    equations.metric = metric_of(S.topLeftCorner(n, n), equations.contacts);
  return equations;
}

Index JointEquations::n_plane_rows() const {
  Index n = n_unknowns();
  for (const auto& rim : rims) n -= rim.size();
  return n;
}

Index JointEquations::entry_of(Index row) const {
  Index end = n_plane_rows();
  if (row < end) return row / n_directions();
  Index rim = 0;
  while (row >= (end += rims[rim].size())) ++rim;
  return n_planes() + rim;
}

std::vector<Index> JointEquations::rim_sizes() const {
  std::vector<Index> sizes;
  for (const auto& rim : rims) sizes.push_back(rim.size());
  return sizes;
}

VectorXd JointEquations::rim_stiffness() const {
  VectorXd stiffness(n_unknowns() - n_plane_rows());
  Index first = 0;
  for (const auto& rim : rims) {
    stiffness.segment(first, rim.size()).setConstant(rim.stiffness());
    first += rim.size();
  }
  return stiffness;
}

bool JointEquations::has_interference() const {
  return std::ranges::any_of(rims, [](const RimContact& rim) { return rim.gap() < 0; });
}

double JointEquations::force_of_clearances() const {
  double force = 0;
  for (const auto& contact : contacts) force = std::max(force, contact.stiffness * contact.law->gap(contact.clearance));
  return force;
}

double JointEquations::force_of_gaps() const {
  double force = 0;
  for (const auto& rim : rims) force = std::max(force, rim.stiffness() * std::abs(rim.gap()));
  return force;
}

ContactState contact_state(const JointEquations& equations, const VectorXd& c) {
  Index first = equations.n_plane_rows();
  ContactState state = contact_state(equations.contacts, c.head(first));
  if (equations.rims.empty()) return state;
  for (VectorXd* vector : {&state.F, &state.delta}) vector->conservativeResize(c.size());
  for (const auto& rim : equations.rims) {
    const double k = rim.stiffness();
    const VectorXd m = c.segment(first, rim.size()) / k;
    Touching touching = rim.touching(m);
    state.F.segment(first, rim.size()) = rim.forces(touching, m);
    state.delta.segment(first, rim.size()) = m;
    if (equations.system.H_shear.cols() > 0) add_friction(rim, touching, m, state);
    state.dF.rims.push_back(std::move(touching.share));
    state.ddelta.rims.emplace_back(MatrixXd::Identity(rim.size(), rim.size()) / k);
    first += rim.size();
  }
  return state;
}

MatrixXd gradient(const JointEquations& equations, const MatrixXd& residuals) {
  const Index n = equations.n_plane_rows(), k = residuals.rows() - n;
  MatrixXd g(residuals.rows(), residuals.cols());
  g.topRows(n) = equations.metric * residuals.topRows(n);
  if (k > 0)
    g.bottomRows(k) = equations.rim_stiffness().cwiseInverse().asDiagonal() *
                      (residuals.bottomRows(k) + equations.system.S_ud.bottomLeftCorner(k, n) * g.topRows(n));
  return g;
}

void add_shear_slopes(const CondensedSystem& system, const ContactState& state, MatrixXd& J) {
  if (state.dshear.empty()) return;
  Index shear = 0, moment = state.direction.size();
  for (const MatrixXd& rim : state.dshear) {
    if (rim.rows() > 0) J.middleCols(moment, rim.cols()) += system.H_shear.middleCols(shear, rim.rows()) * rim;
    shear += rim.rows();
    moment += rim.cols();
  }
}

MatrixXd tangent(const CondensedSystem& system, const ContactState& state, bool friction) {
  MatrixXd J = state.times(system.S_ud, state.ddelta);
  state.add(1, state.dF, J);
  if (!friction) return J;
  if (!system.friction.empty()) J += state.times(system.friction_matrix(state.F), state.dF);
  add_shear_slopes(system, state, J);
  return J;
}

MatrixXd hessian(const JointEquations& equations, const ContactState& state) {
  MatrixXd H = equations.metric;
  state.add(-1, state.ddelta, H);
  return H;
}

RootProblem root_problem(const JointEquations& equations, double load_factor, double scale,
                         const ContactState* frozen) {
  const CondensedSystem& system = equations.system;
  VectorXd load = load_factor * system.q_at(load_factor);
  if (frozen) load -= system.friction_forces(frozen->F, frozen->shear);
  const bool friction = system.has_friction() && !frozen;
  RootProblem problem;
  const auto residual = [&equations, load, scale, friction](const ContactState& state) -> VectorXd {
    VectorXd r = state.F + equations.system.S_ud * state.delta - load;
    if (friction) r += equations.system.friction_forces(state.F, state.shear);
    return r / scale;
  };
  problem.residual = [&equations, residual, scale](const VectorXd& x) {
    return residual(contact_state(equations, scale * x));
  };
  const auto traced = [&equations, residual, scale](const VectorXd& x) {
    auto state = contact_state(equations, scale * x);
    add_trace(equations, residual(state).cwiseAbs().maxCoeff(), state);
    return state;
  };
  problem.jacobian = [&equations, traced, friction](const VectorXd& x) -> MatrixXd {
    return tangent(equations.system, traced(x), friction);
  };
  const bool convex = equations.metric.size() > 0 && !friction;
  if (convex) problem.gradient = [&equations](const VectorXd& r) { return gradient(equations, r); };
  problem.solve = [&equations, traced, friction, convex](const VectorXd& x, const VectorXd& r) -> VectorXd {
    const ContactState state = traced(x);
    if (convex && equations.rims.empty()) {
      const Eigen::LLT<MatrixXd> factor(hessian(equations, state));
      if (factor.info() == Eigen::Success) return factor.solve(gradient(equations, r));
    }
    return TangentFactor(tangent(equations.system, state, friction), equations.rim_sizes()).solve(r);
  };
  return problem;
}

LinearForces linear_forces(const CondensedSystem& system, const VectorXd& flexibility, double load_factor,
                           const std::vector<Index>& rims) {
  constexpr int most_tries = 8;
  MatrixXd A = system.S_ud * flexibility.asDiagonal();
  A.diagonal().array() += 1;
  const VectorXd rhs = load_factor * system.q_at(load_factor);
  LinearForces result{TangentFactor(A, rims).solve(rhs), 1, system.friction.empty()};
  while (!result.consistent && result.solves < most_tries) {
    const VectorXd before = system.E * result.F;
    result.F = TangentFactor(A + system.friction_matrix(result.F), rims).solve(rhs);
    result.consistent = ((system.E * result.F).array() * before.array() >= 0).all();
    ++result.solves;
  }
  return result;
}

VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor) {
  const CondensedSystem& system = equations.system;
  const Index n = equations.n_plane_rows();
  VectorXd flexibility = VectorXd::Zero(system.q.size());
  flexibility.tail(flexibility.size() - n) = equations.rim_stiffness().cwiseInverse();
  if (initial.guess == Guess::linear) {
    const double K = initial.stiffness.value_or(system.S_ud.diagonal().head(n).mean());
    flexibility.head(n).setConstant(K > 0 ? 1 / K : 0);
    return linear_forces(system, flexibility, load_factor, equations.rim_sizes()).F;
  }
  VectorXd rigid = linear_forces(system, flexibility, load_factor, equations.rim_sizes()).F;
  if (initial.guess == Guess::rigid) return rigid;
  const VectorXd mean = rigid.head(n).reshaped(equations.n_directions(), equations.n_planes()).rowwise().mean();
  rigid.head(n) = mean.replicate(equations.n_planes(), 1);
  return rigid;
}

VectorXd guessed_coordinates(const JointEquations& equations, const VectorXd& F) {
  const Index n = equations.n_plane_rows();
  VectorXd c = F;  // of rims whose springs also pull
  c.head(n) = contact_coordinates(equations.contacts, F.head(n));
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
