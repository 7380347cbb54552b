// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stage3_nonlinear/equations/tangent_factor.hpp"
#include "stage3_nonlinear/interfaces/rim_interface.hpp"

namespace fastjoint::stage3 {
namespace {

/// Adds a small stiffness to vanishing slopes in the Jacobian, not in the residual. It falls with the residual, so that
/// Newton's method converges fast also if a plate has springs as weak as this (docs/theory.md, section 8.5).
void add_small_stiffness(const JointEquations& equations, double residual, ContactState& state) {
  constexpr double max_stiffness = 1e-7;
  constexpr double min_stiffness = 1e-11;  // rounding divided by this is still a small step
  const double stiffness = std::clamp(max_stiffness * residual, min_stiffness, max_stiffness);
  for (Index i = 0; i < std::ssize(state.parts); ++i)
    equations.interfaces[i].interface->add_small_stiffness(stiffness, state.parts[i]);
}

/// Throws if a hole has friction here but none in the condensed joint.
void check_friction(const JointModel& joint, const Parameters& parameters) {
  Index at = 0;
  for (const auto& fastener : joint.fasteners)
    for (const auto& hole : fastener.holes)
      if (parameters.mu[at++] != 0 && !hole.has_friction)
        throw std::logic_error("make_equations: friction in a hole that has none in the condensed joint");
}

/// Appends an interface to the others.
void place(std::shared_ptr<const Interface> interface, std::vector<PlacedInterface>& to) {
  Index row = 0, friction = 0;
  if (!to.empty()) {
    row = to.back().row + to.back().interface->size();
    friction = to.back().friction + to.back().interface->n_friction();
  }
  to.push_back({std::move(interface), row, friction});
}

void place_fasteners(const JointModel& joint, JointEquations& equations) {
  const FrictionLayout& layout = equations.system->friction;
  Index plane = 0, hole = 0;
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i) {
    const FastenerModel& fastener = joint.fasteners[i];
    const Index n_planes = fastener.n_planes(), n_holes = std::ssize(fastener.holes);
    const VectorXd mu = equations.parameters.mu.segment(hole, n_holes);
    equations.has_cosine_friction = equations.has_cosine_friction || (layout.n_columns[i] > 0 && !mu.isZero(0));
    place(
        std::make_shared<FastenerInterface>(
            std::vector(equations.contacts.begin() + plane, equations.contacts.begin() + plane + n_planes),
            FastenerInterface::Place{plane, hole, joint.n_directions(), fastener.law_includes_friction,
                                     std::vector(mu.begin(), mu.end()), layout.friction_holes[i], layout.n_columns[i]}),
        equations.interfaces);
    plane += n_planes;
    hole += n_holes;
  }
}

/// Appends the rims of contact, each with the gap and the friction of the fastener in it and as many waves as these ask
/// for under the largest force of rigid fasteners.
/// @param like The same rims with other parameters, if there are any.
void place_rims(const JointModel& joint, const std::vector<std::shared_ptr<const RimProblem>>& like,
                JointEquations& equations) {
  const auto places = rim_places(joint);
  const auto rigid = [&](double load_factor) {
    return equations.rigid_forces(load_factor).head(equations.n_plane_rows()).lpNorm<Eigen::Infinity>();
  };
  const double force = places.empty() ? 0 : std::max(rigid(0), rigid(1));
  for (Index i = 0; i < std::ssize(places); ++i) {
    const auto& [plate, at, hole, may_rub] = places[i];
    const double gap = hole < 0 ? 0 : equations.parameters.gap[hole], mu = hole < 0 ? 0 : equations.parameters.mu[hole];
    const ContactWaves& all = *joint.plates[plate].contact_waves[at];
    const double k = equations.system->stiffness[equations.n_planes() + i], area = joint.plates[plate].contact[at].area;
    const int order = all.order(gap, force), to_compare = all.order_to_compare(order, mu);
    const bool compares = to_compare != order && (all.has_root_at_end(mu) || joint.plates[plate].has_peak_errors());
    const auto waves = all.up_to(order), compared = compares ? all.up_to(to_compare) : nullptr;
    const auto make = [&](const auto& its, auto other) {
      return std::make_shared<const RimProblem>(its, area, k, gap, mu, std::move(other));
    };
    const bool is_alike = !like.empty() && like[i]->waves() == waves &&
                          (like[i]->compared() ? like[i]->compared()->waves() : nullptr) == compared;
    equations.rims.push_back(is_alike ? std::make_shared<const RimProblem>(like[i]->with(gap, mu))
                                      : make(waves, compares ? make(compared, nullptr) : nullptr));
    equations.has_friction = equations.has_friction || mu != 0;
    place(std::make_shared<RimInterface>(equations.rims.back(), i, may_rub), equations.interfaces);
  }
}

/// Forces of rigid fasteners by the loads of the load columns, (r).
VectorXd rigid_forces_by(const CondensedSystem& system, const VectorXd& loads) {
  return without_rounding(system.Q * loads, loads.cwiseAbs().cwiseProduct(system.Q_scale).lpNorm<Eigen::Infinity>());
}

}  // namespace

JointEquations make_equations(const JointModel& joint, std::shared_ptr<const CondensedSystem> system,
                              Parameters parameters, const std::vector<std::shared_ptr<const RimProblem>>& like) {
  JointEquations equations{std::move(system), std::move(parameters), {}, {}, {}, {}, {}};
  for (Index j = 0; j < joint.n_planes(); ++j)
    equations.contacts.push_back({equations.parameters.law[j], equations.parameters.clearance[j],
                                  equations.system->stiffness[j], joint.planes[j].one_sided});
  equations.rises = std::ranges::all_of(equations.contacts, [](const Contact& each) { return each.law->rises(); });
  check_friction(joint, equations.parameters);
  place_fasteners(joint, equations);
  equations.q = rigid_forces_by(*equations.system, equations.load_rates(1));
  equations.q_reversed = rigid_forces_by(*equations.system, equations.load_rates(-1));
  place_rims(joint, like, equations);
  equations.has_friction = equations.has_friction || equations.has_cosine_friction;
  return equations;
}

Index JointEquations::entry_of(Index row) const {
  Index end = n_plane_rows();
  if (row < end) return row / n_directions();
  Index rim = 0;
  while (row >= (end += rims[rim]->n_long())) ++rim;
  return n_planes() + rim;
}

VectorXd JointEquations::of_rim(const VectorXd& c, Index rim) const {
  const PlacedInterface& placed = interfaces[std::ssize(interfaces) - std::ssize(rims) + rim];
  return c.segment(placed.row, placed.interface->size());
}

double JointEquations::force_of_clearances() const {
  double force = 0;
  for (const auto& contact : contacts) force = std::max(force, contact.stiffness * contact.law->gap(contact.clearance));
  return force;
}

double JointEquations::force_of_gaps(bool interference_alone) const {
  double force = 0;
  for (const auto& rim : rims)
    if (const double gap = rim->contact().gap(); gap < 0 || !interference_alone)
      force = std::max(force, std::max(rim->k(), rim->contact().stiffness()) * std::abs(gap));
  return force;
}

double JointEquations::force_of_sets() const {
  double force = 0;
  const auto all = memories();
  for (std::size_t j = 0; j < all.size(); ++j) force = std::max(force, contacts[j].stiffness * all[j].set.norm());
  return force;
}

void JointEquations::commit(const VectorXd& c) {
  history.resize(interfaces.size());
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const auto& [interface, row, friction] = interfaces[i];
    history[i] = interface->commit(c.segment(row, interface->size()), history[i]);
  }
}

std::vector<PlaneMemory> JointEquations::memories() const {
  std::vector<PlaneMemory> all;
  if (!remembers()) return all;
  for (std::size_t i = 0; i < interfaces.size() && std::ssize(all) < n_planes(); ++i) {
    const auto of_interface = interfaces[i].interface->memories(history.empty() ? History() : history[i]);
    all.insert(all.end(), of_interface.begin(), of_interface.end());
  }
  return all;
}

VectorXd JointEquations::of_active_columns(double load_factor, const VectorXd& values) const {
  const auto& columns = system->load_columns;
  const VectorXd load = parameters.load_at(load_factor);
  return VectorXd::NullaryExpr(std::ssize(columns), [&](Index i) {
    const Index at = columns[i].load;
    const double rate = parameters.load[at];  // a load of zero counts as one that grows with the load factor
    return is_active(columns[i].sign, load[at], rate != 0 ? rate : load_factor) ? values[at] : 0;
  });
}

VectorXd JointEquations::q_at(double load_factor) const {
  if (starts_unloaded()) return load_factor < 0 ? q_reversed : q;
  return rigid_forces_by(*system, load_rates(load_factor));
}

VectorXd JointEquations::rigid_forces(double load_factor) const {
  if (starts_unloaded()) return load_factor * q_at(load_factor);
  const VectorXd& offset = parameters.offset;
  VectorXd by_loads = rigid_forces_by(*system, load_at(load_factor));
  if (offset.size() == 0) return by_loads;
  return by_loads + without_rounding(system->S_ud.leftCols(offset.size()) * offset, force_of_offsets());
}

double JointEquations::force_of_offsets() const {
  const Index n = parameters.offset.size();
  if (n == 0) return 0;
  return (system->S_ud.leftCols(n).cwiseAbs() * parameters.offset.cwiseAbs()).maxCoeff();
}

VectorXd JointEquations::deforming(const VectorXd& delta) const {
  VectorXd result = delta;
  result.head(parameters.offset.size()) -= parameters.offset;
  return result;
}

VectorXd JointEquations::required(const ContactState& state, bool friction) const {
  VectorXd forces = state.F + system->S_times(state.delta);
  if (friction) forces += system->H * state.Lambda;
  return forces;
}

MatrixXd JointEquations::friction_matrix(const VectorXd& F) const {
  MatrixXd M = MatrixXd::Zero(F.size(), F.size());
  for (const auto& [interface, row, friction] : interfaces) {
    const Index n = interface->size();
    const MatrixXd by_force = interface->friction_by_force(F.segment(row, n));
    if (by_force.size() > 0)
      M.middleCols(row, n).noalias() += system->H.middleCols(friction, by_force.rows()) * by_force;
  }
  return M;
}

ContactState contact_state(const JointEquations& equations, const VectorXd& c) {
  return contact_state(equations.interfaces, equations.history, equations.n_directions(), equations.n_planes(), c);
}

RootProblem root_problem(const JointEquations& equations, double load_factor, double scale,
                         const ContactState* frozen) {
  const CondensedSystem& system = *equations.system;
  VectorXd load = equations.rigid_forces(load_factor);
  const bool friction = equations.has_friction && !frozen;
  if (equations.has_friction && frozen) load -= system.H * frozen->Lambda;
  RootProblem problem;
  const auto residual = [&equations, load, scale, friction](const ContactState& state) -> VectorXd {
    return (equations.required(state, friction) - load) / scale;
  };
  problem.residual = [&equations, residual, scale](const VectorXd& x) {
    return residual(contact_state(equations, scale * x));
  };
  const auto stiffened = [&equations, residual, scale, friction](const VectorXd& x) {
    auto state = contact_state(equations, scale * x);
    add_small_stiffness(equations, residual(state).cwiseAbs().maxCoeff(), state);
    if (!friction) state.leave_out_friction();
    return state;
  };
  problem.jacobian = [&system, stiffened](const VectorXd& x) { return tangent(system, stiffened(x)); };
  if (equations.rises && !friction)
    problem.metric = [&system](const VectorXd& step) { return system.metric_times(step); };
  problem.solve = [&system, stiffened](const VectorXd& x, const VectorXd& r) -> VectorXd {
    constexpr double of_residual = 0.1, least = 1e-7, most = 1e-2;  // the residual after a step is of order |r|^2
    return TangentFactor(system, stiffened(x)).step(r, std::clamp(of_residual * r.norm(), least, most));
  };
  return problem;
}

}  // namespace fastjoint::stage3
