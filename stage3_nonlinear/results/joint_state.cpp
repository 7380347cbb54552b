// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The laws' forces on the plates by fastener and hole, each (a), force.
using Bearing = std::vector<std::vector<VectorXd>>;

Bearing bearing_forces(const JointModel& joint, const VectorXd& F) {
  const Index a = joint.n_directions();
  Bearing bearing;
  for (const auto& fastener : joint.fasteners) bearing.emplace_back(fastener.holes.size(), VectorXd::Zero(a));
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    bearing[plane.fastener][plane.first] -= F.segment(j * a, a);
    bearing[plane.fastener][plane.first + 1] += F.segment(j * a, a);
  }
  return bearing;
}

/// Friction case of a hole for a bearing force; null without friction.
const FrictionLoad* friction_at(const HoleModel& hole, Index direction, double bearing) {
  if (hole.friction.empty()) return nullptr;
  return &hole.friction[direction][bearing < 0 ? minus_side : plus_side];
}

/// @param side 0: in the first hole of each plane, 1: in the second.
VectorXd transferred(const JointModel& joint, const VectorXd& F, const Bearing& bearing, std::size_t side) {
  const Index a = joint.n_directions();
  VectorXd result = F;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const std::size_t hole = plane.first + side;
    for (Index d = 0; d < a; ++d)
      if (const auto* friction =
              friction_at(joint.fasteners[plane.fastener].holes[hole], d, bearing[plane.fastener][hole][d]))
        result[j * a + d] *= friction->bearing + friction->resultant;
  }
  return amounts(result, a);
}

/// Forces that act on one plate and that its rows ask for.
struct PlateForces {
  VectorXd asked;     ///< (m+e) S u + R Lambda + T f
  VectorXd discs;     ///< (m) by the fasteners' bearing
  VectorXd friction;  ///< (m) by their friction
  VectorXd Lambda;    ///< (h) stress
};

void add_hole(PlateForces& forces, const HoleModel& hole, const VectorXd& bearing) {
  for (Index d = 0; d < bearing.size(); ++d) {
    const double b = bearing[d];
    const FrictionLoad* friction = friction_at(hole, d, b);
    forces.discs[hole.disc + d] += friction ? friction->bearing * b : b;
    if (!friction || friction->load.size() == 0) continue;
    forces.asked += friction->load * std::abs(b);
    forces.Lambda[friction->case_index] += friction->peak * std::abs(b);
    forces.friction[hole.disc + d] += b * friction->resultant;
  }
}

PlateForces plate_forces(const JointModel& joint, std::size_t at, const VectorXd& u, double load_factor,
                         const Bearing& bearing) {
  const PlateModel& plate = joint.plates[at];
  const VectorXd none = VectorXd::Zero(plate.n_discs());
  PlateForces forces{plate.S * u + load_factor * (plate.T * plate.traction_force), none, none,
                     VectorXd::Zero(plate.friction_unit_force.size())};
  for (std::size_t i = 0; i < joint.fasteners.size(); ++i)
    for (std::size_t hole = 0; hole < joint.fasteners[i].holes.size(); ++hole)
      if (joint.fasteners[i].holes[hole].plate == at)
        add_hole(forces, joint.fasteners[i].holes[hole], bearing[i][hole]);
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
    if (plate.external_displacement[i]) state.Pe[i] = forces.asked[m + i];
    worst = std::max(worst, std::abs(forces.asked[m + i] - state.Pe[i]));
    state.applied[plate.external_axis[i]] += state.Pe[i];
  }
  for (Index i = 0; i < state.traction.size(); ++i) state.applied[plate.traction_axis[i]] += state.traction[i];
  for (Index i = 0; i < m; ++i) state.by_fasteners[plate.axis_of(i)] += forces.discs[i] + forces.friction[i];
  state.by_supports = -(state.applied + state.by_fasteners);
  return worst;
}

/// Worst component of what the holes of a fastener give it altogether, bearing and friction, of all fasteners, force.
double worst_fastener(const JointModel& joint, const std::vector<PlateForces>& plates) {
  double worst = 0;
  for (const auto& fastener : joint.fasteners) {
    VectorXd sum = VectorXd::Zero(joint.n_directions());
    for (const auto& hole : fastener.holes) {
      const PlateForces& forces = plates[hole.plate];
      sum += (forces.discs + forces.friction).segment(hole.disc, sum.size());
    }
    worst = std::max(worst, sum.lpNorm<Eigen::Infinity>());
  }
  return worst;
}

/// Worst force that the supports of a plate must give along axes along which it has none, since it moves as one without
/// force; none if there are no such axes.
std::optional<double> given_by_no_support(const PlateModel& plate, const PlateState& state) {
  constexpr double rounding = 1e-9;
  std::optional<double> worst;
  for (const int axis : {0, 1}) {
    VectorXd motion(plate.n_unknowns());
    for (Index i = 0; i < motion.size(); ++i) {
      const Index external = i - plate.n_discs();
      motion[i] = (external < 0 ? plate.axis_of(i) : plate.external_axis[external]) == axis;
    }
    if (motion.isZero(0) || (plate.S * motion).norm() > rounding * plate.S.norm()) continue;
    worst = std::max(worst.value_or(0), std::abs(state.by_supports[axis]));
  }
  return worst;
}

}  // namespace

JointState joint_state(const JointModel& joint, const CondensedSystem& system, const PathStep& step) {
  const VectorXd D = system.displacements(step.F, step.delta, step.load_factor);
  JointState state;
  state.plates.resize(joint.plates.size());
  const Bearing bearing = bearing_forces(joint, step.F);
  state.transferred_first = transferred(joint, step.F, bearing, 0);
  state.transferred_second = transferred(joint, step.F, bearing, 1);
  state.largest_force = step.F.lpNorm<Eigen::Infinity>();
  std::vector<PlateForces> forces;
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateModel& plate = joint.plates[i];
    const VectorXd u = D.segment(joint.offset(i), plate.n_unknowns());
    forces.push_back(plate_forces(joint, i, u, step.load_factor, bearing));
    state.out_of_balance = std::max(state.out_of_balance, fill(state.plates[i], plate, forces[i], u, step.load_factor));
    if (const auto worst = given_by_no_support(plate, state.plates[i]))
      state.plates_out_of_balance = std::max(state.plates_out_of_balance.value_or(0), *worst);
    const double traction = std::abs(step.load_factor) * plate.traction_force.lpNorm<Eigen::Infinity>();
    state.largest_force = std::max({state.largest_force, state.plates[i].Pe.lpNorm<Eigen::Infinity>(), traction});
  }
  state.fasteners_out_of_balance = worst_fastener(joint, forces);
  if (!(state.largest_force > 0)) return state;
  for (double* worst : {&state.out_of_balance, &state.fasteners_out_of_balance}) *worst /= state.largest_force;
  if (state.plates_out_of_balance) *state.plates_out_of_balance /= state.largest_force;
  return state;
}

std::vector<JointState> balanced_states(const JointModel& joint, const CondensedSystem& system, double tolerance,
                                        LoadPath& path) {
  const double allowed = std::max(1e-8, 10 * tolerance);
  std::vector<JointState> states;
  for (std::size_t i = 0; i < path.steps.size(); ++i) {
    JointState state = joint_state(joint, system, path.steps[i]);
    const auto [worst, what] =
        std::max({std::pair(state.out_of_balance, "a row"), std::pair(state.fasteners_out_of_balance, "a fastener"),
                  std::pair(state.plates_out_of_balance.value_or(0), "a sheet")});
    if (!(worst <= allowed)) {
      const double reached = i > 0 ? path.steps[i - 1].load_factor : 0;
      path.failure = PathFailure{i, path.steps[i].load_factor, reached, 0, 0, {}, {}, what, worst, allowed};
      path.steps.erase(path.steps.begin() + i, path.steps.end());
      break;
    }
    states.push_back(std::move(state));
  }
  return states;
}

VectorXd shares(const JointModel& joint, const VectorXd& transferred) {
  constexpr double rounding = 1e-9;
  VectorXd passed = transferred;  // with the sign that it has when the lower plate comes first; amounts have none
  std::vector<std::pair<std::size_t, std::size_t>> plates;  // of each plane, ascending
  for (Index j = 0; j < passed.size(); ++j) {
    const std::size_t first = joint.first_hole(joint.planes[j]).plate,
                      second = joint.second_hole(joint.planes[j]).plate;
    plates.push_back(std::minmax(first, second));
    if (joint.n_directions() == 1 && first > second) passed[j] = -passed[j];
  }
  VectorXd result(passed.size());
  for (Index j = 0; j < result.size(); ++j) {
    double sum = 0, amount = 0;
    for (Index i = 0; i < result.size(); ++i) {
      if (plates[i] != plates[j]) continue;
      sum += passed[i];
      amount += std::abs(passed[i]);
    }
    const bool known = std::abs(sum) > rounding * amount;
    result[j] = known ? 100 / sum * passed[j] : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

}  // namespace fastjoint::stage3
