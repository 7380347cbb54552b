// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/count.hpp"
#include "stage3_nonlinear/output/csv_field.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/results/contact_history.hpp"
#include "stage3_nonlinear/results/near_peaks.hpp"
#include "stage3_nonlinear/results/row_forces.hpp"

namespace fastjoint::stage3 {
namespace {

/// Stresses one degree apart around all holes of a plate at every increment.
formats::RimStresses rim_stresses(const std::vector<std::string>& holes, const std::vector<JointState>& states,
                                  Index at) {
  const auto rims = [&](Index step) -> const auto& { return states[step].plates[at].loaded; };
  formats::RimStresses a;
  a.start = Eigen::VectorXi::Zero(std::ssize(holes) + 1);
  if (states.empty()) return a;
  std::vector<std::pair<Index, VectorXd>> sampled;  // index of a rim, and places on it, in the order of holes
  for (Index i = 0; i < std::ssize(holes); ++i) {
    a.start[i + 1] = a.start[i];
    for (Index j = 0; j < std::ssize(rims(0)); ++j)
      if (const auto& rim = rims(0)[j]; rim && rim->rim.hole == holes[i])
        a.start[i + 1] += count_of(sampled.emplace_back(j, rim->places()).second);
  }
  const Index n = a.start[std::ssize(holes)];
  a.angle.resize(n);
  for (auto* table : {&a.rr, &a.tt, &a.rt}) table->resize(std::ssize(states), n);
  for (Index step = 0; step < std::ssize(states); ++step) {
    Index next = 0;
    for (const auto& [rim, places] : sampled) {
      const MatrixXd stresses = rims(step)[rim]->stresses(places);
      a.angle.segment(next, places.size()) = places;
      for (const auto& [table, column] : {std::pair(&a.rr, 0), std::pair(&a.tt, 1), std::pair(&a.rt, 2)})
        table->row(step).segment(next, places.size()) = stresses.col(column).transpose();
      next += places.size();
    }
  }
  return a;
}

formats::CrackHistory crack_history(const formats::CrackRows& cracks, const std::vector<JointState>& states, Index at) {
  const Index n = std::ssize(states), t = std::ssize(cracks.tip);
  formats::CrackHistory a{cracks.tip, cracks.at, cracks.length, MatrixXd(n, t), MatrixXd(n, t), {}, {}};
  for (Index step = 0; step < n && t > 0; ++step) {
    a.K_I.row(step) = states[step].plates[at].cracks.K_I;
    a.K_II.row(step) = states[step].plates[at].cracks.K_II;
  }
  a.K_I_error = a.K_II_error = MatrixXd::Constant(n, t, std::numeric_limits<double>::infinity());
  return a;
}

/// Sets the resultants and the rows of a plate.
void set_totals(const PlateModel& plate, const std::vector<JointState>& states, Index at,
                formats::PlateHistory& history) {
  const auto rows = disc_rows(plate);
  const Index n = std::ssize(states), w = std::ssize(rows);
  for (auto* table : {&history.applied, &history.by_fasteners, &history.by_supports}) table->resize(n, 2);
  auto& its = history.rows;
  for (auto* table : {&its.force, &its.before, &its.after}) table->resize(n, w);
  its.at.resize(w), its.holes.resize(w);
  for (Index i = 0; i < w; ++i) {
    its.direction.emplace_back(rim::axis_names[rows[i].axis]);
    its.at[i] = rows[i].at;
    its.holes[i] = count_of(rows[i].discs);
  }
  for (Index step = 0; step < n; ++step) {
    const PlateState& state = states[step].plates[at];
    history.applied.row(step) = state.applied;
    history.by_fasteners.row(step) = state.by_fasteners;
    history.by_supports.row(step) = state.by_supports;
    const RowForces forces = row_forces(plate, rows, state);
    its.force.row(step) = forces.force;
    its.before.row(step) = forces.before;
    its.after.row(step) = forces.after;
  }
}

formats::PlateHistory plate_history(const PlateModel& plate, const std::vector<JointState>& states, Index at,
                                    const MoreStresses& wanted) {
  formats::PlateHistory history;
  history.name = plate.name;
  history.materials = plate.materials;
  history.matrices_digest = plate.matrices_digest;
  history.plate_digest = plate.plate_digest;
  for (const Index i : plate.discs) {
    history.disc_hole.push_back(plate.hole_of(i));
    history.disc_direction.emplace_back(rim::axis_names[plate.axis_of(i)]);
  }
  history.external_id = plate.externals;
  history.traction_id = plate.tractions;
  history.traction_bearing = names_of(plate.traction_bearing);
  history.traction_bearing.resize(plate.tractions.size());
  history.contact = plate.contact;
  history.friction_hole = plate.friction_hole;
  history.friction_bearing = names_of(plate.friction_bearing);
  const auto rows = [&](VectorXd PlateState::*values, Index n) {
    MatrixXd result(std::ssize(states), n);
    for (Index step = 0; step < result.rows(); ++step) result.row(step) = states[step].plates[at].*values;
    return result;
  };
  const auto of_discs = [&](VectorXd PlateState::*values) -> MatrixXd {
    return rows(values, plate.n_discs())(Eigen::all, plate.discs);
  };
  history.D = of_discs(&PlateState::D);
  history.De = rows(&PlateState::De, plate.n_externals());
  history.free_D = MatrixXd::Zero(history.D.rows(), history.D.cols());
  history.free_De = MatrixXd::Zero(history.De.rows(), history.De.cols());
  if (plate.free.De.size() == plate.n_externals() && plate.free.D.size() == plate.n_discs()) {
    history.free_D.rowwise() = plate.free.D(plate.discs).transpose();
    history.free_De.rowwise() = plate.free.De.transpose();
    history.D += history.free_D;
    history.De += history.free_De;
  }
  history.Pe = rows(&PlateState::Pe, plate.n_externals());
  Index n_added = 0, n_w = 0;
  for (Index i = 0; i < std::ssize(plate.contact); ++i) {
    history.waves.push_back(plate.waves[i]);
    history.waves.back().waves = formats::waves_of_field(plate.contact[i], plate.waves[i]);
    n_added += history.waves.back().size();
    n_w += plate.contact[i].pressures.size();
  }
  history.amounts = rows(&PlateState::added, n_added);
  history.w = rows(&PlateState::w, n_w);
  history.Lambda = rows(&PlateState::Lambda, plate.R.cols()).leftCols(std::ssize(plate.friction_hole));
  history.traction = rows(&PlateState::traction, std::ssize(plate.tractions));
  history.traction_arm = plate.traction_arm;
  history.traction_arm.resize(plate.tractions.size());
  history.traction_displacement = rows(&PlateState::traction_displacement, std::ssize(plate.tractions));
  if (plate.free.traction.size() == history.traction_displacement.cols())
    history.traction_displacement.rowwise() += plate.free.traction.transpose();
  set_totals(plate, states, at, history);
  history.disc_forces = {of_discs(&PlateState::bearing), of_discs(&PlateState::friction)};
  history.border = plate.border;
  history.cracks = crack_history(plate.cracks, states, at);
  if (plate.stress_level) history.rims = rims_of(plate.stresses);
  if (plate.stress_level && wanted.all_around) history.rims.stresses = rim_stresses(history.rims.hole, states, at);
  if (plate.stress_level && wanted.distance)
    history.rims.near =
        near_stresses(plate, states, at, *wanted.distance, history.rims.stresses ? &*history.rims.stresses : nullptr);
  for (const auto& state : states) {
    const auto& rims = state.plates[at].rims;
    history.rims.values.emplace_back(rims.begin(), rims.end());
  }
  return history;
}

formats::PeakSlopes peak_slopes(const JointModel& joint, const JointNumbers& numbers, const PeakSensitivity& all) {
  Index column = 1;
  const auto next = [&](Index count) -> MatrixXd {
    return all.slopes.middleCols(std::exchange(column, column + count), count);
  };
  return {.hole = all.hole,
          .load_factor = all.slopes.col(0),
          .clearance = next(joint.n_planes()),
          .law = next(std::ssize(numbers.law)),
          .mu = next(std::ssize(numbers.friction) + std::ssize(numbers.rim_friction)),
          .force = next(std::ssize(numbers.force)),
          .displacement = next(std::ssize(numbers.displacement)),
          .gap = next(std::ssize(numbers.gap))};
}

/// Values of a hole's columns at a step, each after a comma; empty if not known.
std::string rim_fields(const formats::RimHistory& rims, const std::string& hole, Index step) {
  const int at = index_of(rims.hole, hole);
  std::string fields;
  for (const auto& each : formats::rim_quantities()) {
    const bool has = at < count_of(rims.hole) && (!each.needs_section || rims.sections[at] > 0);
    const double value = has ? rims.values[step][at].*each.value : std::nan("");
    fields += std::isfinite(value) ? fmt::format(",{}", value) : ",";
  }
  return fields;
}

/// Heads of the columns with their units, with components of delta and F if there are two directions.
std::string csv_heads(const JointModel& joint) {
  const std::string length = unit(joint.units, 1, 0), force = unit(joint.units, 0, 1);
  const auto with_unit = [](const std::string& name, const std::string& unit) { return name + " [" + unit + "]"; };
  std::vector<std::string> heads{"increment", "load_factor", "fastener", with_unit("delta", length)};
  for (const char* name : {"F", "transferred_first", "transferred_second"}) heads.push_back(with_unit(name, force));
  heads.insert(heads.end(), {"share [%]", "iterations", "residual", "first", "second"});
  for (const auto& [vector, unit] : {std::pair("delta_", length), std::pair("F_", force)})
    for (Index d = 0; joint.n_directions() > 1 && d < std::ssize(joint.axes); ++d)
      heads.push_back(with_unit(std::string(vector) + joint.axis_name(d), unit));
  for (const char* side : {"first", "second"})
    for (const auto& each : formats::rim_quantities()) {
      const std::string name = fmt::format("{}_{}", each.name, side);
      const bool has_unit = each.dimension != formats::Dimension::ratio;
      heads.push_back(has_unit ? with_unit(name, unit_of(each.dimension, joint.units)) : name);
    }
  heads.insert(heads.end(), {with_unit("F_error", force), "event", "joint", "case"});
  std::ranges::transform(heads, heads.begin(), csv_field);
  return fmt::format("{}\n", fmt::join(heads, ","));
}

}  // namespace

formats::JointResult joint_result(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                                  const Increments& increments, const MoreStresses& wanted) {
  const auto& states = increments.states;
  const Index steps = path.steps.size(), n = joint.n_planes(), a = joint.n_directions();
  formats::JointResult result;
  result.p = joint.p;
  result.complete = !path.failure;
  result.converged = Eigen::VectorXi::Ones(steps);
  result.iterations.resize(steps);
  for (auto* list : {&result.load_factor, &result.residual}) list->resize(steps);
  for (auto* table : {&result.delta, &result.F}) table->resize(steps, n);
  result.transferred.resize(steps, 2 * n);
  for (auto* table : {&result.delta_vector, &result.F_vector}) table->resize(steps, n * a);
  for (Index i = 0; i < steps; ++i) {
    const PathStep& step = path.steps[i];
    result.load_factor[i] = step.load_factor;
    result.iterations[i] = step.iterations;
    result.residual[i] = step.residual;
    result.event.push_back(event_text(joint, step.events));
    result.delta_vector.row(i) = step.delta;
    result.F_vector.row(i) = step.F;
    for (Index j = 0; j < std::ssize(step.memories); ++j) {
      if (i == 0 && j == 0) result.set.resize(steps, n * a), result.dissipated.resize(steps, n);
      result.set.row(i).segment(j * a, a) = step.memories[j].set;
      result.dissipated(i, j) = step.memories[j].dissipated;
    }
    result.delta.row(i) = magnitudes(step.delta, a);
    result.F.row(i) = magnitudes(step.F, a);
    for (Index j = 0; j < n; ++j)
      result.transferred.row(i).segment<2>(2 * j) << states[i].transferred_first[j], states[i].transferred_second[j];
  }
  for (Index i = 0; i < steps; ++i) {
    const auto& loads = increments.stiffness[i];
    result.load_stiffness.conservativeResize(steps, std::ssize(loads));
    for (Index at = 0; at < std::ssize(loads); ++at) {
      if (i == 0) result.load_external.push_back(loads[at].external);
      result.load_stiffness(i, at) = loads[at].stiffness;
    }
  }
  for (const auto& plane : joint.planes) {
    result.fastener_id.push_back(joint.fasteners[plane.fastener].id);
    result.first_hole.push_back(joint.name(joint.first_hole(plane)));
    result.second_hole.push_back(joint.is_to_ground(plane) ? ground_name : joint.name(joint.second_hole(plane)));
  }
  result.F_error = increments.F_error;
  for (Index d = 0; d < std::ssize(joint.axes); ++d) result.direction.emplace_back(joint.axis_name(d));
  auto contacts = contact_histories(joint, equations, path);
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    result.plates.push_back(plate_history(joint.plates[i], states, i, wanted));
    result.plates.back().contacts = std::move(contacts[i]);
  }
  return result;
}

formats::SensitivityHistory sensitivity_history(const JointModel& joint, const LoadPath& path,
                                                const Increments& increments) {
  const JointNumbers& numbers = increments.numbers;
  formats::SensitivityHistory history;
  history.mu_hole = numbers.friction;
  history.mu_hole.insert(history.mu_hole.end(), numbers.rim_friction.begin(), numbers.rim_friction.end());
  for (const auto& [law, number] : numbers.law) {
    history.law_name.push_back(law);
    history.law_number.push_back(number.name);
    history.law_unit.push_back(unit(joint.units, -number.length, 1 - number.force));
  }
  history.force_external = numbers.force;
  history.displacement_external = numbers.displacement;
  history.gap_hole = numbers.gap;
  history.load_factor.resize(std::ssize(path.steps), joint.n_planes());
  for (const auto& each : increments.sensitivity) {
    history.load_factor.row(std::ssize(history.clearance)) = each.load_factor.transpose();
    history.clearance.push_back(each.clearance);
    history.law.push_back(each.law);
    history.mu.push_back(each.mu);
    history.force.push_back(each.force);
    history.displacement.push_back(each.displacement);
    history.gap.push_back(each.gap);
  }
  if (increments.peak) history.peak = peak_slopes(joint, numbers, *increments.peak);
  return history;
}

std::string csv(const JointModel& joint, const formats::JointResult& a) {
  std::string text = csv_heads(joint);
  for (Index i = 0; i < a.F.rows(); ++i) {
    const auto first = [&](Index j) { return a.transferred(i, 2 * j); };
    const VectorXd share = shares(joint, VectorXd::NullaryExpr(a.F.cols(), first));
    for (Index j = 0; j < a.F.cols(); ++j) {
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", increment_number(a, i), a.load_factor[i],
                          csv_field(a.fastener_id[j]), a.delta(i, j), a.F(i, j), a.transferred(i, 2 * j),
                          a.transferred(i, 2 * j + 1), std::isfinite(share[j]) ? fmt::to_string(share[j]) : "",
                          a.iterations[i], a.residual[i], csv_field(a.first_hole[j]), csv_field(a.second_hole[j]));
      const Index directions = joint.n_directions();
      for (const auto* vectors : {&a.delta_vector, &a.F_vector})
        for (Index d = 0; directions > 1 && d < directions; ++d)
          text += fmt::format(",{}", (*vectors)(i, j * directions + d));
      for (const HoleModel& hole : joint.holes(joint.planes[j]))
        text += rim_fields(a.plates[hole.plate].rims, joint.plates[hole.plate].hole_of(hole.disc), i);
      if (joint.is_to_ground(joint.planes[j])) text += rim_fields({}, "", i);
      text += fmt::format(",{},{},{},{}\n", a.F_error ? fmt::to_string((*a.F_error)(i, j)) : "", csv_field(a.event[i]),
                          csv_field(a.header.name), csv_field(a.case_name[a.case_of[i]]));
    }
  }
  return text;
}

}  // namespace fastjoint::stage3
