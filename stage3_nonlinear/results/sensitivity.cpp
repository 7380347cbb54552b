// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/sensitivity.hpp"

#include <map>

#include "stage3_nonlinear/equations/implicit_slopes.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Changes by all numbers at fixed c, one column each: load factor, clearances, laws, mu, forces, displacements.
struct Changes {
  MatrixXd F;         ///< (n a, columns)
  MatrixXd residual;  ///< (n a, columns)
};

/// Derivatives dF and d delta at fixed c by the clearances, then by the numbers of the laws, each of shape (n a, n +
/// l).
std::pair<MatrixXd, MatrixXd> law_changes(const JointEquations& equations, const JointNumbers& numbers,
                                          const ContactState& state, const VectorXd& c) {
  const Index a = state.direction.rows(), n = state.direction.cols();
  MatrixXd F = MatrixXd::Zero(n * a, n + std::ssize(numbers.law));
  MatrixXd delta = F;
  for (Index j = 0; j < n; ++j) {
    const Contact& contact = equations.contacts[j];
    const VectorXd here = c.segment(j * a, a);
    if (here.isZero(0) || contact.is_pulled_open(here)) continue;
    const auto slopes = contact.law->slopes(here.norm(), contact.stiffness, contact.clearance);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const Index column = i == 0 ? j : n + numbers.first_of_law[j] + i - 1;
      F.block(j * a, column, a, 1) = slopes[i].F * state.direction.col(j);
      delta.block(j * a, column, a, 1) = slopes[i].delta * state.direction.col(j);
    }
  }
  return {F, delta};
}

/// dG / dmu of a hole for a row of its fastener and the side that bears there, over the unknowns of the row's plate.
VectorXd change_of_row(const JointModel& joint, const FrictionRow& row, Side side, std::size_t by) {
  const FastenerModel& fastener = joint.fasteners[row.fastener];
  const HoleModel& hole = fastener.holes[row.hole];
  const FrictionLoad& friction = hole.friction[row.direction][side];
  const double mu = fastener.holes[by].mu, transferred = friction.bearing + friction.resultant;
  double relative = row.hole == by ? -friction.resultant / transferred / mu : 0;  // d ln bearing / d mu
  if (!fastener.law_includes_friction)
    relative += part_of_mean_share(fastener, by, row.hole, row.direction, side) / transferred / mu;
  VectorXd change = VectorXd::Zero(joint.plates[hole.plate].n_unknowns());
  for (Index i = 0; i < friction.load.size(); ++i)
    change[i] = (relative + (row.hole == by ? 1 / mu : 0)) * friction.load[i];
  change[hole.disc + row.direction] -= (side == plus_side ? 1 : -1) * relative * friction.bearing;
  return change;
}

/// Derivatives of H by the friction of a hole, by reciprocity: dH = D_delta^T dG (docs/theory.md, section 7.1).
FrictionHole friction_hole(const JointModel& joint, const CondensedSystem& system, std::size_t fastener,
                           std::size_t hole) {
  FrictionHole result{joint.name(joint.fasteners[fastener].holes[hole]), fastener, hole, {}};
  for (Index i = 0; i < std::ssize(system.friction); ++i) {
    const FrictionRow& row = system.friction[i];
    if (row.fastener != fastener) continue;
    const std::size_t plate = joint.fasteners[fastener].holes[row.hole].plate;
    const auto D = system.D_delta.middleRows(joint.offset(plate), joint.plates[plate].n_unknowns());
    const auto dH = [&](Side side) -> VectorXd { return D.transpose() * change_of_row(joint, row, side, hole); };
    result.rows.push_back({i, dH(plus_side), dH(minus_side)});
  }
  return result;
}

/// Changes of the residual by each mu, (n a, f).
MatrixXd friction_changes(const CondensedSystem& system, const std::vector<FrictionHole>& holes, const VectorXd& F) {
  MatrixXd changes = MatrixXd::Zero(F.size(), std::ssize(holes));
  const VectorXd b = system.E * F;
  for (Index i = 0; i < changes.cols(); ++i)
    for (const auto& [row, plus, minus] : holes[i].rows)
      changes.col(i) += std::abs(b[row]) * (b[row] < 0 ? minus : plus);
  return changes;
}

Changes changes(const JointEquations& equations, const JointNumbers& numbers, const ContactState& state,
                const VectorXd& c, double load_factor) {
  const CondensedSystem& system = equations.system;
  const auto [F, delta] = law_changes(equations, numbers, state, c);
  MatrixXd by_law = F + system.S_ud * delta;
  if (system.has_friction()) by_law += system.friction_matrix(state.F) * F;
  const MatrixXd by_mu = friction_changes(system, numbers.friction, state.F);
  const UnitLoads& loads = numbers.loads;
  Changes all;
  all.residual.resize(c.size(), 1 + by_law.cols() + by_mu.cols() + loads.q_force.cols() + loads.q_displacement.cols());
  all.residual << -system.q, by_law, by_mu, -load_factor * loads.q_force, -load_factor * loads.q_displacement;
  all.F = MatrixXd::Zero(c.size(), all.residual.cols());
  all.F.middleCols(1, F.cols()) = F;
  return all;
}

/// Adds a load under its name.
/// @param D_delta Rows of one plate, (m+e, n a).
/// @param load    Forces on its unknowns, (m+e).
void add(std::vector<std::string>& names, MatrixXd& q, const std::string& name, const MatrixXd& D_delta,
         const VectorXd& load) {
  names.push_back(name);
  q.conservativeResize(Eigen::NoChange, q.cols() + 1);
  q.rightCols(1) = without_rounding(D_delta.transpose() * load, load.cwiseAbs().maxCoeff());
}

}  // namespace

UnitLoads unit_loads(const JointModel& joint, const CondensedSystem& system) {
  const Index rows = system.q.size();
  UnitLoads loads{{}, MatrixXd(rows, 0), {}, MatrixXd(rows, 0)};
  for (std::size_t p = 0; p < joint.plates.size(); ++p) {
    const PlateModel& plate = joint.plates[p];
    const MatrixXd D = system.D_delta.middleRows(joint.offset(p), plate.n_unknowns());
    for (Index i = 0; i < plate.n_externals(); ++i) {
      const std::string name = plate.name + ":" + plate.externals[i];
      const Index unknown = plate.n_discs() + i;
      if (plate.external_displacement[i]) {
        add(loads.displacement, loads.q_displacement, name, D, -plate.S.col(unknown));
      } else {
        add(loads.force, loads.q_force, name, D, VectorXd::Unit(plate.n_unknowns(), unknown));
      }
    }
    for (std::size_t i = 0; i < plate.tractions.size(); ++i)
      add(loads.force, loads.q_force, plate.name + ":" + plate.tractions[i], D, -plate.T.col(i));
  }
  return loads;
}

JointNumbers joint_numbers(const JointModel& joint, const CondensedSystem& system) {
  JointNumbers numbers;
  numbers.loads = unit_loads(joint, system);
  for (std::size_t i = 0; i < system.friction.size(); ++i) {
    const FrictionRow& row = system.friction[i];
    if (row.direction == 0 && joint.fasteners[row.fastener].holes[row.hole].mu > 0)
      numbers.friction.push_back(friction_hole(joint, system, row.fastener, row.hole));
  }
  std::map<std::string, Index> first;
  for (const auto& plane : joint.planes) {
    const auto [at, is_new] = first.try_emplace(plane.law_name, std::ssize(numbers.law));
    numbers.first_of_law.push_back(at->second);
    if (!is_new) continue;
    for (const auto& parameter : plane.law->parameters()) numbers.law.push_back({plane.law_name, parameter});
  }
  return numbers;
}

Sensitivity sensitivity(const JointEquations& equations, const JointNumbers& numbers, const PathStep& step) {
  const VectorXd c = coordinates(equations.contacts, step.F, step.delta);
  ContactState state = contact_state(equations.contacts, c);
  const Changes all = changes(equations, numbers, state, c, step.load_factor);
  if (equations.system.has_friction() && state.F.isZero(0)) bear(equations, state);
  Slopes slopes = implicit_slopes(equations.system, state, all.residual);
  slopes.F += all.F;
  const MatrixXd dF = of_amounts(slopes, state, c);
  Index column = 0;
  const auto next = [&](Index count) -> MatrixXd {
    column += count;
    return dF.middleCols(column - count, count);
  };
  Sensitivity result;
  result.load_factor = next(1);
  result.clearance = next(std::ssize(equations.contacts));
  result.law = next(std::ssize(numbers.law));
  result.mu = next(std::ssize(numbers.friction));
  result.force = next(numbers.loads.q_force.cols());
  result.displacement = next(numbers.loads.q_displacement.cols());
  return result;
}

}  // namespace fastjoint::stage3
