// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "stage3_nonlinear/equations/rim_friction.hpp"

namespace fastjoint::stage3 {
namespace {

/// The laws' forces on the plates by fastener and hole, that on the ground behind the last, each (a), force.
using Bearing = std::vector<std::vector<VectorXd>>;

Bearing bearing_forces(const JointModel& joint, const VectorXd& F) {
  const Index a = joint.n_directions();
  Bearing bearing;
  for (const auto& fastener : joint.fasteners) bearing.emplace_back(fastener.n_planes() + 1, VectorXd::Zero(a));
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    bearing[plane.fastener][plane.first] -= F.segment(j * a, a);
    bearing[plane.fastener][plane.first + 1] += F.segment(j * a, a);
  }
  return bearing;
}

/// Friction case of a hole for a bearing force; that without a load if there is no friction.
const FrictionLoad& friction_at(const HoleModel& hole, Index direction, double bearing) {
  static const FrictionLoad none;
  return hole.friction.empty() ? none : hole.friction[direction][bearing < 0 ? minus_side : plus_side];
}

/// @param side 0: in the first hole of each plane, 1: in the second; the ground gets what leaves the last hole.
VectorXd transferred(const JointModel& joint, const VectorXd& F, const Bearing& bearing, Index side) {
  const Index a = joint.n_directions();
  VectorXd result = F;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const Index hole = joint.is_to_ground(plane) ? plane.first : plane.first + side;
    for (Index d = 0; d < a; ++d) {
      const double b = bearing[plane.fastener][hole][d];
      const FrictionLoad& friction = friction_at(joint.fasteners[plane.fastener].holes[hole], d, b);
      result[j * a + d] *= friction.bearing + friction.resultant;
    }
  }
  return amounts(result, a);
}

/// Adds what a fastener's bearing forces, (a), and their friction do to a plate in one of its holes.
/// @param asked (m+e) S u + R Lambda + T f of the plate's rows, force.
void add_hole(PlateState& state, VectorXd& asked, const HoleModel& hole, const VectorXd& bearing) {
  for (Index d = 0; d < std::ssize(bearing); ++d) {
    const double b = bearing[d];
    const FrictionLoad& friction = friction_at(hole, d, b);
    state.bearing[hole.disc + d] += friction.bearing * b;
    if (friction.load.size() == 0) continue;
    asked += friction.load * std::abs(b);
    state.Lambda[friction.case_index] += friction.peak * std::abs(b);
    state.friction[hole.disc + d] += b * friction.resultant;
    if (friction.across == 0) continue;
    const Index other = hole.disc + 1 - d;
    const double across = friction.across * std::abs(b);
    state.friction[other] += across;
    for (double* bearing_there : {&state.bearing[other], &asked[other]}) *bearing_there -= across;
  }
}

/// Adds the shears of a plate's rims of contact: what they ask of its rows, and their share of the force on each disc.
/// @param shear Of all rims from the plate's on; what it has taken is cut off.
void add_shears(const JointModel& joint, Index at, VectorXd& asked, VectorXd& shear, PlateState& state) {
  const PlateModel& plate = joint.plates[at];
  for (const auto& rim : plate.contact) {
    if (joint.mu(at, rim.hole) == 0) continue;
    const Index n = rim.pressures.n_shears(), first = plate.first_shear(rim);
    state.Lambda.segment(first, n) = shear.head(n) / rim.area;
    asked += plate.R.middleCols(first, n) * state.Lambda.segment(first, n);
    for (Index disc = 0; disc < plate.n_discs(); ++disc) {
      if (plate.hole_of(disc) != rim.hole) continue;
      state.friction[disc] = rim.pressures.drag(plate.axis_of(disc)).dot(shear.head(n));
      state.bearing[disc] -= state.friction[disc];
    }
    shear = shear.tail(shear.size() - n).eval();
  }
}

/// The rims of contact of a plate.
std::vector<RimContact> rims_of_contact(const JointModel& joint, Index at) {
  std::vector<RimContact> rims;
  for (const auto& rim : joint.plates[at].contact)
    rims.emplace_back(rim.pressures, rim.modulus * rim.area, joint.gap(at, rim.hole), joint.mu(at, rim.hole));
  return rims;
}

/// Amounts of the unit cases of a plate's file.
VectorXd unit_case_amounts(const PlateModel& plate, const PlateState& state) {
  const Index h = std::ssize(plate.friction_hole);
  const VectorXd D = state.D(plate.discs);
  VectorXd amounts(state.De.size() + D.size() + state.waves.size() + h + state.traction.size());
  amounts << state.De, D, state.waves, state.Lambda.head(h), state.traction;
  return amounts;
}

/// The discs that the plate's file has, with their forces.
LoadedDiscs loaded_discs(const PlateModel& plate, const PlateState& state) {
  LoadedDiscs discs{{}, {}, state.bearing(plate.discs), state.friction(plate.discs)};
  for (const Index disc : plate.discs) {
    discs.hole.push_back(plate.hole_of(disc));
    discs.axis.push_back(plate.axis_of(disc));
  }
  return discs;
}

/// @param u         (m+e+k) displacements of the plate and moments of its rims.
/// @param rim_F     (k) forces of these.
/// @param shear     Forces of the shears of this plate's rims and of those behind it; cut to the latter.
/// @param worst_row Raised to what the plate's worst row is out of balance, force.
PlateState plate_state(const JointModel& joint, Index at, const VectorXd& u, const VectorXd& rim_F,
                       const PathStep& step, const Bearing& bearing, VectorXd& shear, double& worst_row) {
  const PlateModel& plate = joint.plates[at];
  const Index m = plate.n_discs(), k = rim_F.size();
  const double factor = step.load_factor;
  const VectorXd none = VectorXd::Zero(m);
  VectorXd asked = plate.S * u + factor * (plate.T * plate.traction_rate(factor));
  PlateState state{.D = u.head(m),
                   .De = u.segment(m, plate.n_externals()),
                   .Pe = factor * plate.external_force,
                   .moments = u.tail(k),
                   .waves = {},
                   .added = {},
                   .Lambda = VectorXd::Zero(plate.R.cols()),
                   .traction = factor * plate.traction_rate(factor),
                   .bearing = none,
                   .friction = none};
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i)
    for (Index hole = 0; hole < std::ssize(joint.fasteners[i].holes); ++hole)
      if (joint.fasteners[i].holes[hole].plate == at)
        add_hole(state, asked, joint.fasteners[i].holes[hole], bearing[i][hole]);
  const VectorXd on_discs = state.bearing;  // in holes of contact with their friction
  add_shears(joint, at, asked, shear, state);
  load_rims(plate, rims_of_contact(joint, at), state);
  if (plate.stress_level)
    state.rims = rim_states(plate.stresses, *plate.stress_level, unit_case_amounts(plate, state),
                            loaded_discs(plate, state), step.scale, state.loaded);
  worst_row = std::max(
      {worst_row, (asked.head(m) - on_discs).cwiseAbs().maxCoeff(), (asked.tail(k) + rim_F).lpNorm<Eigen::Infinity>()});
  for (Index i = 0; i < std::ssize(state.Pe); ++i) {
    if (plate.external_displacement[i]) state.Pe[i] = asked[m + i];
    worst_row = std::max(worst_row, std::abs(asked[m + i] - state.Pe[i]));
    state.applied[plate.external_axis[i]] += state.Pe[i];
  }
  for (Index i = 0; i < std::ssize(state.traction); ++i) {
    state.applied[plate.traction_axis[i]] += state.traction[i];
    state.applied[1 - plate.traction_axis[i]] += state.traction[i] * entry_or_0(plate.traction_resultant_across, i);
  }
  for (Index i = 0; i < m; ++i) state.by_fasteners[plate.axis_of(i)] += state.bearing[i] + state.friction[i];
  state.by_supports = -(state.applied + state.by_fasteners);
  return state;
}

/// Worst component of what the holes of a fastener give it altogether, bearing and friction, of all fasteners that
/// the ground does not hold, force.
double worst_fastener(const JointModel& joint, const std::vector<PlateState>& plates) {
  double worst = 0;
  for (const auto& fastener : joint.fasteners) {
    if (fastener.grounded) continue;
    VectorXd sum = VectorXd::Zero(joint.n_directions());
    for (const auto& hole : fastener.holes) {
      const PlateState& plate = plates[hole.plate];
      sum += (plate.bearing + plate.friction).segment(hole.disc, sum.size());
    }
    worst = std::max(worst, sum.lpNorm<Eigen::Infinity>());
  }
  return worst;
}

}  // namespace

void load_rims(const PlateModel& plate, std::span<const RimContact> rims, PlateState& state) {
  const Index h = std::ssize(plate.friction_hole), n_shears = plate.R.cols() - h;
  state.waves.resize(plate.n_loaded_waves);
  state.added.resize(state.moments.size() + n_shears);
  std::vector<ContactLoad> loads;
  Index row = 0, shear = h, next = 0, next_added = 0;
  for (Index i = 0; i < std::ssize(rims); ++i) {
    const auto& [pressures, modulus, area] =
        std::tie(plate.contact[i].pressures, plate.contact[i].modulus, plate.contact[i].area);
    const ShortWaves& waves = plate.short_waves[i];
    const Index k = pressures.size(), s = pressures.n_shears();
    loads.push_back(contact_load(rims[i], waves, area, state.moments.segment(row, k), state.Lambda.segment(shear, s)));
    row += k, shear += s;
    state.waves.segment(next, waves.n_carried()) = wave_amounts(loads[i], waves, modulus);
    next += waves.n_carried();
    state.added.segment(next_added, k + s) << loads[i].pressure - modulus * loads[i].moments, loads[i].shear;
    next_added += k + s;
  }
  if (plate.stress_level) state.loaded = loaded_rims(plate, unit_case_amounts(plate, state), loads);
}

JointState joint_state(const JointModel& joint, const CondensedSystem& system, const PathStep& step) {
  const VectorXd D = system.displacements(step.all_F(), step.all_delta(), step.load_factor, step.shear);
  JointState state;
  VectorXd shear = step.shear;
  const Bearing bearing = bearing_forces(joint, step.F);
  state.transferred_first = transferred(joint, step.F, bearing, 0);
  state.transferred_second = transferred(joint, step.F, bearing, 1);
  state.largest_force = std::max(step.F.lpNorm<Eigen::Infinity>(), step.scale);
  Index first_moment = 0;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const VectorXd u = D.segment(joint.offset(i), plate.n_unknowns());
    const Index k = plate.n_unknowns() - plate.first_moment();
    const PlateState& its = state.plates.emplace_back(
        plate_state(joint, i, u, step.rim_F.segment(first_moment, k), step, bearing, shear, state.out_of_balance));
    first_moment += k;
    // Matrices do not tell: a sheet that supports hold without statical indeterminacy moves without force as well.
    for (const int axis : plate.unsupported_axes)
      state.plates_out_of_balance = std::max(state.plates_out_of_balance.value_or(0), std::abs(its.by_supports[axis]));
    for (const VectorXd* forces : {&its.Pe, &its.traction})
      state.largest_force = std::max(state.largest_force, forces->lpNorm<Eigen::Infinity>());
  }
  state.fasteners_out_of_balance = worst_fastener(joint, state.plates);
  if (!(state.largest_force > 0)) return state;
  for (double* worst : {&state.out_of_balance, &state.fasteners_out_of_balance}) *worst /= state.largest_force;
  if (state.plates_out_of_balance) *state.plates_out_of_balance /= state.largest_force;
  return state;
}

VectorXd shares(const JointModel& joint, const VectorXd& transferred) {
  constexpr double rounding = 1e-9;
  VectorXd passed = transferred;  // with the sign that it has when the lower plate comes first; amounts have none
  std::vector<std::pair<Index, Index>> plates;  // of each plane, ascending
  for (Index j = 0; j < std::ssize(passed); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const Index ground = joint.plates.size();
    const Index first = joint.first_hole(plane).plate;
    const Index second = joint.is_to_ground(plane) ? ground : joint.second_hole(plane).plate;
    plates.push_back(std::minmax(first, second));
    if (joint.n_directions() == 1 && first > second) passed[j] = -passed[j];
  }
  VectorXd result(passed.size());
  for (Index j = 0; j < std::ssize(result); ++j) {
    double sum = 0, amount = 0;
    for (Index i = 0; i < std::ssize(result); ++i) {
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
