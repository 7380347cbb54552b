// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/sensitivity_history.hpp"

#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {

formats::SensitivityHistory sensitivity_history(const JointModel& joint, const JointEquations& equations,
                                                const LoadPath& path) {
  const JointNumbers numbers = joint_numbers(joint, equations.system);
  formats::SensitivityHistory history;
  for (const auto& hole : numbers.friction) history.mu_hole.push_back(hole.name);
  for (const auto& number : numbers.law) {
    history.law_name.push_back(number.law);
    history.law_number.push_back(number.parameter.name);
    history.law_unit.push_back(unit(joint.units, -number.parameter.length, 1 - number.parameter.force));
  }
  history.force_external = numbers.loads.force;
  history.displacement_external = numbers.loads.displacement;
  history.load_factor.resize(std::ssize(path.steps), joint.n_planes());
  for (const auto& step : path.steps) {
    Sensitivity each = sensitivity(equations, numbers, step);
    history.load_factor.row(std::ssize(history.clearance)) = each.load_factor.transpose();
    history.clearance.push_back(std::move(each.clearance));
    history.law.push_back(std::move(each.law));
    history.mu.push_back(std::move(each.mu));
    history.force.push_back(std::move(each.force));
    history.displacement.push_back(std::move(each.displacement));
  }
  return history;
}

}  // namespace fastjoint::stage3
