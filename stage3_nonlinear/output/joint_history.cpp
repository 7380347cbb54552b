// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/contact_quantities.hpp"
#include "stage3_nonlinear/results/crack_quantities.hpp"
#include "stage3_nonlinear/results/joint_quantities.hpp"
#include "stage3_nonlinear/results/near_peaks.hpp"
#include "stage3_nonlinear/results/rim_stresses.hpp"

namespace fastjoint::stage3 {
namespace {

/// A plate at increments. @param errors Of its cracks.
formats::PlateHistory plate_history(const std::vector<JointAt>& increments, const PlateModel& plate, Index at,
                                    formats::RimsAtNoLoad at_no_load, const MoreStresses& wanted,
                                    const CrackErrors& errors) {
  formats::PlateHistory a = things_of(plate);
  a.at_no_load = std::move(at_no_load);
  std::vector<PlateAt> its;
  for (const JointAt& increment : increments) its.push_back({increment, at});
  auto groups = plate_quantities(plate);
  groups.push_back(crack_error_quantities(plate, errors));
  if (plate.stress_level && wanted.all_around) {
    set_points(its.empty() ? nullptr : &its[0].state(), a.holes);
    groups.push_back(rim_stresses(a.holes));
  }
  if (plate.stress_level && wanted.distance) {
    a.holes.near_distance = *wanted.distance;
    groups.push_back(near_peaks(plate, *wanted.distance));
    if (wanted.all_around) groups.push_back(near_stresses(plate, *wanted.distance, a.holes));
  }
  a.columns = {groups, its};
  return a;
}

}  // namespace

formats::JointResult joint_result(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                                  const Increments& increments, const MoreStresses& wanted,
                                  const std::vector<CrackErrors>& errors) {
  const Index steps = std::ssize(path.steps);
  formats::JointResult result;
  result.p = joint.p;
  result.complete = !path.failure;
  result.converged = Eigen::VectorXi::Ones(steps);
  result.iterations.resize(steps), result.load_factor.resize(steps), result.residual.resize(steps);
  std::vector<JointAt> all;
  for (Index i = 0; i < steps; ++i) {
    const PathStep& step = path.steps[i];
    result.load_factor[i] = step.load_factor;
    result.iterations[i] = step.iterations;
    result.residual[i] = step.residual;
    result.event.push_back(event_text(joint, step.events));
    all.push_back({joint, equations, step, increments.states[i], i});
  }
  for (const auto& plane : joint.planes) {
    result.fastener_id.push_back(joint.fasteners[plane.fastener].id);
    result.first_hole.push_back(joint.name(joint.first_hole(plane)));
    result.second_hole.push_back(joint.is_to_ground(plane) ? ground_name : joint.name(joint.second_hole(plane)));
  }
  for (Index d = 0; d < joint.n_directions(); ++d) result.direction.emplace_back(joint.axis_name(d));
  if (steps > 0)
    for (const auto& load : increments.stiffness[0]) result.load_external.push_back(load.external);
  auto groups = plane_quantities(joint);
  for (auto& some : {memory_quantities(joint, equations), increment_quantities(increments), bending_quantities(joint)})
    groups.insert(groups.end(), some.begin(), some.end());
  result.columns = {groups, all};
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    auto at_no_load = rims_at_no_load(joint, equations, path, i);
    result.plates.push_back(plate_history(all, joint.plates[i], i, std::move(at_no_load), wanted, errors[i]));
  }
  return result;
}

formats::SensitivityHistory sensitivity_history(const JointModel& joint, const Increments& increments) {
  const JointNumbers& numbers = increments.numbers;
  formats::SensitivityHistory history;
  history.kinds = numbers.kinds();
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
  history.F = increments.sensitivity;
  history.peak.resize(0, numbers.n_derivatives());
  if (increments.peak) history.peak_hole = increments.peak->hole, history.peak = increments.peak->slopes;
  return history;
}

}  // namespace fastjoint::stage3
