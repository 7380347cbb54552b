// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/load_stiffness.hpp"

namespace fastjoint::stage3 {
namespace {

/// Rates of the forces of all shears of rims of contact, (s), with those of the contact coordinates, (r).
VectorXd shear_rates(const ContactState& state, const VectorXd& c) {
  VectorXd rates(state.shear.size());
  Index shear = 0, moment = state.dF.along.size() * state.direction.rows();
  for (const MatrixXd& rim : state.dshear) {
    rates.segment(shear, rim.rows()) = rim.lazyProduct(c.segment(moment, rim.cols()));
    shear += rim.rows();
    moment += rim.cols();
  }
  return rates;
}

/// Adds what rates of shears, (s), do to displacements and to forces on all unknowns, (N).
void add_shears(const JointModel& joint, const CondensedSystem& system, const VectorXd& rates, VectorXd& D,
                VectorXd& friction) {
  D += system.D_shear * rates;
  Index first = 0;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (const auto& rim : joint.plates[i].contact) {
      if (joint.mu(i, rim.hole) == 0) continue;
      const PlateModel& plate = joint.plates[i];
      const Index n = rim.pressures.n_shears();
      friction.segment(joint.offset(i), plate.n_unknowns()) +=
          plate.R.middleCols(plate.first_shear(rim), n) * rates.segment(first, n) / rim.area;
      first += n;
    }
}

}  // namespace

std::vector<LoadStiffness> tangent_stiffness(const JointModel& joint, const SolvedPoint& point) {
  const CondensedSystem& system = point.equations().system;
  const ContactState& state = point.beyond();
  const double load_factor = point.load_factor();
  const Slopes slopes = point.slopes(-system.q_at(load_factor));
  const bool gives_way = point.check().at_limit_load() || !slopes.no_column.empty();
  // Rates with the load factor: displacements, and forces on all unknowns as far as they are friction's.
  VectorXd D =
      system.D_load_at(load_factor) + system.D_delta * state.times(slopes.c.transpose(), state.ddelta).transpose();
  VectorXd friction = VectorXd::Zero(D.size());
  for (Index i = 0; i < std::ssize(system.friction); ++i) {
    const Side side = system.E.row(i).dot(state.F) < 0 ? minus_side : plus_side;
    const double rate = (side == plus_side ? 1 : -1) * system.E.row(i).dot(slopes.F.col(0));
    const HoleModel& hole = joint.fasteners[system.friction[i].fastener].holes[system.friction[i].hole];
    const VectorXd& load = hole.friction[system.friction[i].direction][side].load;
    D += rate * (side == plus_side ? system.D_plus : system.D_minus).col(i);
    friction.segment(joint.offset(hole.plate), load.size()) += rate * load;
  }
  if (state.shear.size() > 0) add_shears(joint, system, shear_rates(state, slopes.c.col(0)), D, friction);
  std::vector<LoadStiffness> result;
  for (Index p = 0; p < std::ssize(joint.plates); ++p) {
    const PlateModel& plate = joint.plates[p];
    const Index m = plate.n_discs(), n = plate.n_unknowns();
    const VectorXd u = D.segment(joint.offset(p), n), f = plate.traction_rate(load_factor);
    const auto add = [&](const std::string& name, double force, double moved) {
      result.push_back({plate.name + ":" + name, gives_way ? 0 : force / moved});
    };
    for (Index i = 0; i < plate.n_externals(); ++i) {
      const auto& given = plate.external_displacement[i];
      const double reaction = plate.S.row(m + i).dot(u) + plate.T.row(m + i).dot(f) + friction[joint.offset(p) + m + i];
      if (given.value_or(plate.external_force[i]) != 0)
        add(plate.externals[i], given ? reaction : plate.external_force[i], u[m + i]);
    }
    for (Index i = 0; i < f.size(); ++i)
      if (f[i] != 0) add(plate.tractions[i], f[i], plate.degrees.C.back().row(i).dot(f) - plate.T.col(i).dot(u));
  }
  return result;
}

}  // namespace fastjoint::stage3
