// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace fastjoint::stage3 {
namespace {

/// Load that each plane transfers, with the friction of one of its holes, (n); the magnitude with two directions.
VectorXd transferred(const JointEquations& equations, const VectorXd& F, Index side) {
  VectorXd result(F.size());
  for (const auto& [interface, row, friction] : equations.interfaces)
    if (const Index n = interface->size(); row + n <= F.size())
      result.segment(row, n) = interface->transferred(F.segment(row, n), side);
  return magnitudes(result, equations.n_directions());
}

/// Forces of the laws on all discs, minus the part that friction carries, (N), force.
VectorXd forces_on_discs(const JointModel& joint, const JointEquations& equations, const PathStep& step) {
  const Index a = joint.n_directions();
  VectorXd forces = VectorXd::Zero(joint.n_unknowns());
  const auto disc = [&](const HoleModel& hole) { return joint.offset(hole.plate) + hole.disc; };
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const auto holes = joint.holes(joint.planes[j]);
    forces.segment(disc(holes[0]), a) -= step.F.segment(j * a, a);
    if (holes.size() > 1) forces.segment(disc(holes[1]), a) += step.F.segment(j * a, a);
  }
  const auto& columns = equations.system->friction.columns;
  for (Index i = 0; i < std::ssize(columns); ++i)
    if (columns[i].case_at < 0) forces[joint.offset(columns[i].plate) + columns[i].disc] -= step.Lambda[i];
  return forces;
}

/// Sets the friction forces on the discs of a plate from the peak stresses of its cases. At rims of contact the forces
/// on the discs include friction, which is subtracted from the bearing forces.
void set_friction(const PlateModel& plate, PlateState& state) {
  for (Index i = 0; i < plate.n_friction_cases(); ++i) {
    const auto hole = std::ranges::find(plate.holes, plate.friction_hole[i]);
    const auto side = bearing_side(plate.friction_bearing[i]);
    if (!side) continue;
    const auto [along, sign] = *side;
    const int axis = rim::coordinate(along);
    const auto at = std::ranges::find(plate.axes, axis);
    if (state.Lambda[i] == 0 || hole == plate.holes.end() || at == plate.axes.end()) continue;
    const Index a = std::ssize(plate.axes), disc = (hole - plate.holes.begin()) * a, d = at - plate.axes.begin();
    state.friction[disc + d] += sign * std::abs(plate.friction_resultant[i]) * state.Lambda[i];
    if (a > 1 && plate.has_disc(disc + 1 - d))
      state.friction[disc + 1 - d] += entry_or_0(plate.friction_resultant_across, i) * state.Lambda[i];
  }
  for (const auto& rim : plate.contact) {
    const rim::Harmonics& carried = plate.waves[&rim - plate.contact.data()].waves;
    const VectorXd shear = rim.area * state.Lambda.segment(plate.first_shear(rim), carried.n_shears());
    for (Index disc = 0; disc < plate.n_disc_unknowns(); ++disc) {
      if (plate.hole_of(disc) != rim.hole) continue;
      state.friction[disc] = carried.drag(plate.axis_of(disc)).dot(shear);
      state.bearing[disc] -= state.friction[disc];
    }
  }
}

/// Coefficients of the unit cases of a plate's file.
VectorXd unit_case_coefficients(const PlateModel& plate, const PlateState& state) {
  const Index h = plate.n_friction_cases();
  const VectorXd D = state.D(plate.discs);
  VectorXd coefficients(state.De.size() + D.size() + state.waves.size() + h + state.traction.size());
  coefficients << state.De, D, state.waves, state.Lambda.head(h), state.traction;
  return coefficients;
}

/// The discs in the plate's file with their forces.
LoadedDiscs loaded_discs(const PlateModel& plate, const PlateState& state) {
  LoadedDiscs discs{{}, {}, state.bearing(plate.discs), state.friction(plate.discs)};
  for (const Index disc : plate.discs) {
    discs.hole.push_back(plate.hole_of(disc));
    discs.axis.push_back(plate.axis_of(disc));
  }
  return discs;
}

/// @param rim_F     (k) forces of the moments of the plate's rims.
/// @param on_discs  (m) results of forces_on_discs.
/// @param is_held   (e) externals that are displaced or tied, whose forces are reactions.
/// @param worst_row Maximum of its value and the largest imbalance of a row of the plate, force.
void balance_plate(const PlateModel& plate, const std::vector<bool>& is_held, const VectorXd& rim_F,
                   const VectorXd& on_discs, double scale, bool with_stresses, PlateState& state, double& worst_row) {
  const Index m = plate.n_disc_unknowns(), k = rim_F.size();
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De, state.moments;
  VectorXd required = plate.S * u + plate.T * state.traction;
  if (state.Lambda.size() > 0) required += plate.R * state.Lambda;
  const Index q = state.traction.size();
  state.traction_displacement.setConstant(q, std::numeric_limits<double>::infinity());
  if (q > 0 && plate.C.rows() == q && state.Lambda.isZero(0))
    state.traction_displacement = traction_displacements(plate, u, state.traction);
  state.bearing = on_discs;
  state.friction = VectorXd::Zero(m);
  set_friction(plate, state);
  if (plate.stress_level && with_stresses)
    state.rims = hole_states(plate.stresses, plate.border, *plate.stress_level, unit_case_coefficients(plate, state),
                             loaded_discs(plate, state), scale, state.loaded);
  if (with_stresses) state.cracks = crack_state(plate, unit_case_coefficients(plate, state));
  worst_row = std::max({worst_row, (required.head(m) - on_discs).lpNorm<Eigen::Infinity>(),
                        (required.tail(k) + rim_F).lpNorm<Eigen::Infinity>()});
  for (Index i = 0; i < std::ssize(state.Pe); ++i) {
    if (is_held[i]) state.Pe[i] = required[m + i];
    worst_row = std::max(worst_row, std::abs(required[m + i] - state.Pe[i]));
    state.applied[plate.external_axis[i]] += state.Pe[i];
  }
  for (Index i = 0; i < std::ssize(state.traction); ++i) {
    if (plate.is_moment(i)) continue;  // has no resultant
    state.applied[plate.traction_axis[i]] += state.traction[i];
    state.applied[1 - plate.traction_axis[i]] += state.traction[i] * entry_or_0(plate.traction_resultant_across, i);
  }
  for (Index i = 0; i < m; ++i) state.by_fasteners[plate.axis_of(i)] += state.bearing[i] + state.friction[i];
  state.by_supports = -(state.applied + state.by_fasteners);
}

/// Externals of each plate that are displaced or tied.
std::vector<std::vector<bool>> held_externals(const JointModel& joint, const CondensedSystem& system) {
  std::vector<std::vector<bool>> held;
  for (const auto& plate : joint.plates) held.emplace_back(plate.n_externals(), false);
  for (const auto& its : system.load_columns)
    if (its.is_displacement) held[its.plate][its.at] = true;
  for (const auto& group : system.held.ties)
    for (const auto& [plate, external] : group) held[plate][external] = true;
  return held;
}

/// Force on all externals of each tie.
VectorXd tie_forces(const Held& held, const std::vector<PlateState>& plates) {
  VectorXd sums = VectorXd::Zero(std::ssize(held.ties));
  for (Index i = 0; i < sums.size(); ++i)
    for (const auto& [plate, external] : held.ties[i]) sums[i] += plates[plate].Pe[external];
  return sums;
}

/// Largest component of the resultant of bearing and friction on a fastener, over all that are not grounded, force.
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

MatrixXd displacements(const JointModel& joint, const CondensedSystem& system, const MatrixXd& load,
                       const MatrixXd& delta, const MatrixXd& Lambda) {
  MatrixXd D = system.D_load * load + system.displaced(delta);
  if (Lambda.rows() > 0) D -= system.rigid.moved(friction_loads(joint, system.friction.columns, Lambda));
  return D;
}

std::vector<PlateState> plate_loads(const JointModel& joint, const CondensedSystem& system,
                                    const std::vector<ContactLoad>& contacts, const VectorXd& D, const VectorXd& load,
                                    const VectorXd& Lambda, bool with_stresses) {
  std::vector<PlateState> plates(joint.plates.size());
  for (Index i = 0; i < std::ssize(plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const VectorXd u = D.segment(joint.offset(i), plate.n_unknowns());
    plates[i].D = u.head(plate.n_disc_unknowns());
    plates[i].De = u.segment(plate.n_disc_unknowns(), plate.n_externals());
    plates[i].moments = u.tail(plate.n_unknowns() - plate.first_moment());
    plates[i].Lambda = VectorXd::Zero(plate.R.cols());
    plates[i].Pe = VectorXd::Zero(plate.n_externals());
    plates[i].traction = VectorXd::Zero(plate.n_tractions());
  }
  for (Index i = 0; i < load.size(); ++i) {
    const LoadColumn& its = system.load_columns[i];
    if (its.is_displacement) continue;
    (its.is_traction ? plates[its.plate].traction : plates[its.plate].Pe)[its.at] = load[i];
  }
  for (Index i = 0; i < Lambda.size(); ++i)
    if (const auto& [plate, case_at, disc] = system.friction.columns[i]; case_at >= 0)
      plates[plate].Lambda[case_at] += Lambda[i];
  Index first_rim = 0;
  for (Index i = 0; i < std::ssize(plates); ++i) {
    const Index n = std::ssize(joint.plates[i].contact);
    load_rims(joint.plates[i], {contacts.begin() + first_rim, contacts.begin() + first_rim + n}, plates[i],
              with_stresses);
    first_rim += n;
  }
  return plates;
}

void load_rims(const PlateModel& plate, std::vector<ContactLoad> contacts, PlateState& state, bool with_stresses) {
  std::vector<double> waves, w, added;
  const auto append = [](const VectorXd& part, std::vector<double>& all) {
    all.insert(all.end(), part.begin(), part.end());
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactLoad& load = contacts[i];
    const double modulus = plate.contact[i].modulus;
    const rim::Harmonics of_field = formats::waves_of_field(plate.contact[i], plate.waves[i]);
    append(wave_coefficients(load, modulus), waves);
    append(load.w.head(of_field.size()), w);
    append((load.own.pressure - modulus * load.w).head(of_field.size()), added);
    append(load.own.shear.head(of_field.n_shears()), added);
  }
  const auto vector = [](const std::vector<double>& list) -> VectorXd {
    return Eigen::Map<const VectorXd>(list.data(), std::ssize(list));
  };
  state.waves = vector(waves);
  state.w = vector(w);
  state.added = vector(added);
  if (plate.stress_level && with_stresses)
    state.loaded = loaded_rims(plate, unit_case_coefficients(plate, state), contacts);
}

VectorXd traction_displacements(const PlateModel& plate, const VectorXd& u, const VectorXd& f) {
  return plate.C * f - plate.T.transpose() * u;
}

JointState joint_state(const JointModel& joint, const JointEquations& equations, const PathStep& step,
                       bool with_stresses) {
  const CondensedSystem& system = *equations.system;
  const VectorXd load = equations.load_at(step.load_factor);
  const VectorXd D = displacements(joint, system, load, equations.deforming(step.all_delta()), step.Lambda);
  const VectorXd on_discs = forces_on_discs(joint, equations, step);
  JointState state;
  std::vector<ContactLoad> contacts;
  for (const PlateModel& plate : joint.plates)
    for (Index k = 0; k < std::ssize(plate.contact); ++k) {
      const Index i = std::ssize(contacts);
      contacts.push_back(
          contact_load(*equations.rims[i], equations.of_rim(step.c, i), plate.stress_level && with_stresses));
    }
  state.plates = plate_loads(joint, system, contacts, D, load, step.Lambda, with_stresses);
  state.transferred_first = transferred(equations, step.F, 0);
  state.transferred_second = transferred(equations, step.F, 1);
  state.largest_force = std::max(step.F.lpNorm<Eigen::Infinity>(), step.scale);
  const auto is_held = held_externals(joint, system);
  const VectorXd on_ties = tie_forces(system.held, state.plates);
  Index first_moment = 0;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    PlateState& its = state.plates[i];
    const Index k = its.moments.size();
    balance_plate(plate, is_held[i], step.rim_F.segment(first_moment, k),
                  on_discs.segment(joint.offset(i), plate.n_disc_unknowns()), step.scale, with_stresses, its,
                  state.out_of_balance);
    first_moment += k;
    // The matrices alone do not show the axes: a sheet with statically determinate supports has no stiffness either.
    for (const int axis : plate.unsupported_axes)
      state.plates_out_of_balance = std::max(state.plates_out_of_balance.value_or(0), std::abs(its.by_supports[axis]));
    for (const VectorXd* forces : {&its.Pe, &its.traction})
      state.largest_force = std::max(state.largest_force, forces->lpNorm<Eigen::Infinity>());
  }
  if (on_ties.size() > 0)
    state.out_of_balance =
        std::max(state.out_of_balance, (tie_forces(system.held, state.plates) - on_ties).lpNorm<Eigen::Infinity>());
  state.fasteners_out_of_balance = worst_fastener(joint, state.plates);
  if (!(state.largest_force > 0)) return state;
  for (double* worst : {&state.out_of_balance, &state.fasteners_out_of_balance}) *worst /= state.largest_force;
  if (state.plates_out_of_balance) *state.plates_out_of_balance /= state.largest_force;
  return state;
}

VectorXd shares(const JointModel& joint, const VectorXd& transferred) {
  constexpr double rounding = 1e-9;
  VectorXd passed = transferred;                // with the sign for the lower plate as the first; magnitudes have none
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
    double sum = 0, sum_of_magnitudes = 0;
    for (Index i = 0; i < std::ssize(result); ++i) {
      if (plates[i] != plates[j]) continue;
      sum += passed[i];
      sum_of_magnitudes += std::abs(passed[i]);
    }
    const bool known = std::abs(sum) > rounding * sum_of_magnitudes;
    result[j] = known ? 100 / sum * passed[j] : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

}  // namespace fastjoint::stage3
