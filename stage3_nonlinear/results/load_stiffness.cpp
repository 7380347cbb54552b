// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/load_stiffness.hpp"

#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {
namespace {

/// Rates of the tractions of a plate, (q).
VectorXd traction_rates(const CondensedSystem& system, const VectorXd& rates, Index plate, Index n) {
  VectorXd result = VectorXd::Zero(n);
  for (Index i = 0; i < rates.size(); ++i)
    if (const LoadColumn& its = system.load_columns[i]; its.plate == plate && its.is_traction)
      result[its.at] = rates[i];
  return result;
}

}  // namespace

std::vector<LoadStiffness> tangent_stiffness(const JointModel& joint, const SolvedPoint& point) {
  const JointEquations& equations = point.equations();
  const CondensedSystem& system = *equations.system;
  const VectorXd rates = equations.load_rates(point.load_factor());
  const Slopes slopes = point.slopes(-equations.q_at(point.load_factor()));
  const bool at_limit = point.check().at_limit_load() || !slopes.no_column.empty();
  // Rates with the load factor of displacements, and of the friction forces on all unknowns.
  const VectorXd delta = point.beyond().product(&Response::ddelta, slopes.c);
  const VectorXd Lambda = point.beyond().friction_by(slopes.c);
  const VectorXd D = displacements(joint, system, rates, delta, Lambda);
  const VectorXd friction = friction_loads(joint, system.friction.columns, Lambda);
  std::vector<LoadStiffness> result;
  for (Index i = 0; i < std::ssize(system.load_columns); ++i) {
    const auto& [load, at_plate, at, is_traction, is_displacement, sign] = system.load_columns[i];
    if (rates[i] == 0) continue;
    const PlateModel& plate = joint.plates[at_plate];
    const Index first = joint.offset(at_plate), row = plate.n_disc_unknowns() + at;
    const VectorXd u = D.segment(first, plate.n_unknowns());
    const VectorXd f = traction_rates(system, rates, at_plate, plate.n_tractions());
    const std::string& name = (is_traction ? plate.traction_id : plate.external_id)[at];
    const double reaction = is_traction ? 0 : plate.S.row(row).dot(u) + plate.T.row(row).dot(f) + friction[first + row];
    const double force = is_displacement ? reaction : rates[i];
    const double moved = is_traction ? traction_displacements(plate, u, f)[at] : u[row];
    result.push_back({plate.name + ":" + name, at_limit ? 0 : force / moved});
  }
  return result;
}

}  // namespace fastjoint::stage3
