// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_numbers.hpp"

#include <map>

namespace fastjoint::stage3 {
namespace {

/// What the friction of a hole does to a row of its fastener and the side that bears there.
struct RowChange {
  VectorXd load;  ///< dG / dmu over the unknowns of the row's plate
  double peak;    ///< d FrictionLoad::peak / dmu
};

RowChange change_of_row(const JointModel& joint, const FrictionRow& row, Side side, Index by) {
  const FastenerModel& fastener = joint.fasteners[row.fastener];
  const HoleModel& hole = fastener.holes[row.hole];
  const FrictionLoad& friction = hole.friction[row.direction][side];
  const double mu = fastener.holes[by].mu, transferred = friction.bearing + friction.resultant;
  double relative = row.hole == by ? -friction.resultant / transferred / mu : 0;  // d ln bearing / d mu
  if (!fastener.law_includes_friction)
    relative += part_of_mean_share(fastener, by, row.hole, row.direction, side) / transferred / mu;
  const double rises = relative + (row.hole == by ? 1 / mu : 0);
  VectorXd change = VectorXd::Zero(joint.plates[hole.plate].n_unknowns());
  change.head(friction.load.size()) = rises * friction.load;
  change[hole.disc + row.direction] -= (side == plus_side ? 1 : -1) * relative * friction.bearing;
  return {change, rises * friction.peak};
}

/// Adds the derivatives of H by the friction of a hole, by reciprocity: dH = D_delta^T dG (docs/theory.md,
/// section 7.1).
void add_rows(const JointModel& joint, const CondensedSystem& system, FrictionHole& by) {
  for (Index i = 0; i < std::ssize(system.friction); ++i) {
    const FrictionRow& row = system.friction[i];
    if (row.fastener != by.fastener) continue;
    const Index plate = joint.fasteners[by.fastener].holes[row.hole].plate;
    const auto D = system.D_delta.middleRows(joint.offset(plate), joint.plates[plate].n_unknowns());
    const RowChange plus = change_of_row(joint, row, plus_side, by.hole),
                    minus = change_of_row(joint, row, minus_side, by.hole);
    const HoleModel& hole = joint.fasteners[row.fastener].holes[row.hole];
    by.rows.push_back(
        {i,
         plate,
         {hole.friction[row.direction][plus_side].case_index, hole.friction[row.direction][minus_side].case_index},
         D.transpose() * plus.load,
         D.transpose() * minus.load,
         {plus.load, minus.load},
         {plus.peak, minus.peak}});
  }
}

/// The work of each load on the displacements D_delta, which by reciprocity is its q, without another solve
/// (docs/theory.md, section 7.1), (r, loads).
MatrixXd q_of(const JointModel& joint, const CondensedSystem& system, const std::vector<UnitLoad>& loads) {
  MatrixXd q(system.q.size(), std::ssize(loads));
  for (Index i = 0; i < q.cols(); ++i) {
    const auto& [plate, load, traction, displaced] = loads[i];
    const auto D = system.D_delta.middleRows(joint.offset(plate), load.size());
    q.col(i) = without_rounding(D.transpose() * load, load.cwiseAbs().maxCoeff());
  }
  return q;
}

}  // namespace

std::vector<UnitLoad> unit_forces(const JointModel& joint, double load_factor) {
  std::vector<UnitLoad> loads;
  for (Index p = 0; p < std::ssize(joint.plates); ++p) {
    const PlateModel& plate = joint.plates[p];
    for (Index i = 0; i < plate.n_externals(); ++i)
      if (!plate.external_displacement[i])
        loads.push_back({p, VectorXd::Unit(plate.n_unknowns(), plate.n_discs() + i), {}, {}});
    for (Index i = 0; i < std::ssize(plate.tractions); ++i) {
      if (plate.is_other_side(i)) continue;
      const Index acting = !plate.acts(i, load_factor) && plate.is_other_side(i + 1) ? i + 1 : i;
      loads.push_back({p, -plate.T.col(acting), acting, {}});
    }
  }
  return loads;
}

std::vector<UnitLoad> unit_displacements(const JointModel& joint) {
  std::vector<UnitLoad> loads;
  for (Index p = 0; p < std::ssize(joint.plates); ++p) {
    const PlateModel& plate = joint.plates[p];
    for (Index i = 0; i < plate.n_externals(); ++i)
      if (plate.external_displacement[i])
        loads.push_back({p, -plate.S.col(plate.n_discs() + i), {}, plate.n_discs() + i});
  }
  return loads;
}

JointNumbers names_of_numbers(const JointModel& joint) {
  JointNumbers numbers;
  for (const auto& plate : joint.plates) {
    for (Index i = 0; i < plate.n_externals(); ++i)
      (plate.external_displacement[i] ? numbers.displacement : numbers.force)
          .push_back(plate.name + ":" + plate.externals[i]);
    for (Index i = 0; i < std::ssize(plate.tractions); ++i)
      if (!plate.is_other_side(i)) numbers.force.push_back(plate.name + ":" + plate.tractions[i]);
  }
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i)
    for (Index at = 0; at < std::ssize(joint.fasteners[i].holes); ++at)
      if (const HoleModel& hole = joint.fasteners[i].holes[at];
          hole.mu > 0 && !joint.plates[hole.plate].is_in_contact(joint.plates[hole.plate].hole_of(hole.disc)))
        numbers.friction.push_back({joint.name(hole), i, at, {}});
  numbers.gap = joint.rims();
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (const auto& rim : joint.plates[i].contact)
      if (joint.mu(i, rim.hole) != 0) numbers.shears.push_back(joint.plates[i].name + ":" + rim.hole);
  std::map<std::string, Index> first;
  for (const auto& plane : joint.planes) {
    const auto [at, is_new] = first.try_emplace(plane.law_name, std::ssize(numbers.law));
    numbers.first_of_law.push_back(at->second);
    if (!is_new) continue;
    for (const auto& parameter : plane.law->parameters()) numbers.law.emplace_back(plane.law_name, parameter);
  }
  return numbers;
}

JointNumbers joint_numbers(const JointModel& joint, const CondensedSystem& system) {
  JointNumbers numbers = names_of_numbers(joint);
  numbers.q_force = q_of(joint, system, unit_forces(joint, 1));
  numbers.q_force_reversed = q_of(joint, system, unit_forces(joint, -1));
  numbers.q_displacement = q_of(joint, system, unit_displacements(joint));
  for (FrictionHole& hole : numbers.friction) add_rows(joint, system, hole);
  return numbers;
}

}  // namespace fastjoint::stage3
