// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const FrictionLoad& friction_at(const FastenerEnd& end, double F) {
  return end.friction[F < 0 ? negative_force : positive_force];
}

VectorXd transferred(const JointModel& joint, const VectorXd& F, End end) {
  VectorXd result(F.size());
  for (Index j = 0; j < F.size(); ++j)
    result[j] = F[j] * (1 + friction_at(joint.fasteners[static_cast<std::size_t>(j)].ends[end], F[j]).resultant);
  return result;
}

/// What acts on one plate and what its rows ask for, force.
struct PlateForces {
  VectorXd asked;     ///< (m+e) S u + R Lambda + T f
  VectorXd discs;     ///< (m) by the fasteners' bearing
  VectorXd friction;  ///< (m) by their friction
  VectorXd Lambda;    ///< (h) stress

  [[nodiscard]] double fasteners() const { return discs.sum() + friction.sum(); }
};

PlateForces plate_forces(const JointModel& joint, std::size_t at, const VectorXd& u, const PathStep& step) {
  const PlateModel& plate = joint.plates[at];
  const VectorXd none = VectorXd::Zero(plate.n_discs());
  PlateForces forces{plate.S * u + step.load_factor * (plate.T * plate.traction_force), none, none,
                     VectorXd::Zero(plate.friction_unit_force.size())};
  for (Index j = 0; j < step.F.size(); ++j) {
    const double F = step.F[j];
    for (const End end : {first_plate, second_plate}) {
      const FastenerEnd& fastener = joint.fasteners[static_cast<std::size_t>(j)].ends[end];
      if (fastener.plate != at) continue;
      const double on_plate = end == first_plate ? -F : F;
      const FrictionLoad& friction = friction_at(fastener, F);
      if (friction.load.size() > 0) {
        forces.asked += friction.load * std::abs(F);
        forces.Lambda[friction.case_index] += friction.peak * std::abs(F);
      }
      forces.discs[fastener.disc] += on_plate;
      forces.friction[fastener.disc] += on_plate * friction.resultant;
    }
  }
  return forces;
}

/// Fills in the plate and returns its worst row, force.
double fill(PlateState& state, const PlateModel& plate, const PlateForces& forces, const VectorXd& u, double factor) {
  const Index m = plate.n_discs();
  state.D = u.head(m);
  state.De = u.tail(plate.n_externals());
  state.Pe = factor * plate.external_force;
  state.Lambda = forces.Lambda;
  state.traction = factor * plate.traction_force;
  VectorXd amounts(state.De.size() + m + state.Lambda.size() + state.traction.size());
  amounts << state.De, state.D, state.Lambda, state.traction;
  state.rims = rim_states(plate, {amounts, forces.discs, forces.friction});
  double worst = (forces.asked.head(m) - forces.discs).cwiseAbs().maxCoeff();
  for (Index i = 0; i < state.Pe.size(); ++i) {
    if (plate.external_displacement[static_cast<std::size_t>(i)]) {
      state.Pe[i] = forces.asked[m + i];
    } else {
      worst = std::max(worst, std::abs(forces.asked[m + i] - state.Pe[i]));
    }
  }
  state.applied = state.Pe.dot(plate.external_in_x) + factor * plate.traction_force.dot(plate.traction_in_x);
  state.by_fasteners = forces.fasteners();
  state.by_supports = -(state.applied + state.by_fasteners);
  return worst;
}

double largest(const VectorXd& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

JointState joint_state(const JointModel& joint, const CondensedSystem& system, const PathStep& step) {
  const VectorXd D = system.displacements(step.F, step.delta, step.load_factor);
  JointState state;
  state.plates.resize(joint.plates.size());
  state.transferred_first = transferred(joint, step.F, first_plate);
  state.transferred_second = transferred(joint, step.F, second_plate);
  state.largest_force = largest(step.F);
  double worst = 0;
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateModel& plate = joint.plates[i];
    const VectorXd u = D.segment(joint.offset(i), plate.n_unknowns());
    worst = std::max(worst, fill(state.plates[i], plate, plate_forces(joint, i, u, step), u, step.load_factor));
    const double traction = std::abs(step.load_factor) * largest(plate.traction_force);
    state.largest_force = std::max({state.largest_force, largest(state.plates[i].Pe), traction});
  }
  state.out_of_balance = state.largest_force > 0 ? worst / state.largest_force : worst;
  return state;
}

VectorXd shares(const VectorXd& transferred) {
  constexpr double rounding = 1e-9;
  const double sum = transferred.sum();
  if (!(std::abs(sum) > rounding * transferred.cwiseAbs().sum()))
    return VectorXd::Constant(transferred.size(), std::numeric_limits<double>::quiet_NaN());
  return 100 / sum * transferred;
}

}  // namespace fastjoint::stage3
