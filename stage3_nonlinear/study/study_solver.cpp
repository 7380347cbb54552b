// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_solver.hpp"

#include <limits>
#include <utility>

#include "common/errors.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {
namespace {

/// Follows a joint from no load to its last increment.
std::optional<PathStep> last_step(const JointEquations& equations, const std::vector<double>& load_factors,
                                  const PathOptions& options) {
  Walk walk(equations, options);
  (void)walk.assemble();
  LoadPath path;
  for (const double factor : load_factors)
    if (!walk.reach(factor) || !walk.record(path, {})) return std::nullopt;
  return std::move(path.steps.back());
}

}  // namespace

StudyNames study_names(const JointModel& joint, const StudyScene& study) {
  StudyNames names;
  for (const auto& plane : joint.planes) names.force.push_back(joint.short_name(plane));
  for (const auto& plate : joint.plates) {
    if (study.peaks && plate.stress_level)
      for (const auto& hole : plate.stresses.rim_hole) names.peak.push_back(plate.name + ":" + hole);
    if (study.displacements)
      for (const auto& external : plate.externals) names.displacement.push_back(plate.name + ":" + external);
    if (study.cracks)
      for (const auto& tip : plate.cracks.tip) names.crack.push_back(plate.name + ":" + tip);
  }
  return names;
}

StudySolver::StudySolver(const JointModel& joint, const JointScene& scene, const Parameters& middle, StudyNames names)
    : joint_(joint),
      load_factors_(scene.wanted_load_factors()),
      options_{scene.initial, scene.solver},
      tolerance_(scene.solver.tolerance),
      system_(std::make_shared<const CondensedSystem>(condense(joint))),
      names_(std::move(names)) {
  const JointEquations equations = make_equations(joint, system_, middle);
  rims_ = equations.rims;
  const auto step = last_step(equations, load_factors_, options_);
  middle_ = step ? numbers(equations, *step) : nothing(SampleStatus::not_solved);
  if (middle_.status != SampleStatus::solved) return;
  start_ = step->c;
  (void)contact_state(equations, step->c);  // samples start at the last solutions of the rims
}

SampleNumbers StudySolver::nothing(SampleStatus status) const {
  return {status, VectorXd::Constant(names_.size(), std::numeric_limits<double>::quiet_NaN()), {}};
}

SampleNumbers StudySolver::numbers(const JointEquations& equations, const PathStep& step) const {
  const JointState state = joint_state(joint_, equations, step);
  if (imbalance(state, tolerance_)) return nothing(SampleStatus::out_of_balance);
  SampleNumbers result{SampleStatus::solved, VectorXd(names_.size()), {}};
  result.all.head(joint_.n_planes()) = state.transferred_first.cwiseAbs();
  Index at = joint_.n_planes();
  if (!names_.peak.empty())
    for (const auto& plate : state.plates)
      for (const auto& rim : plate.rims) result.all[at++] = rim.peak_hoop;
  if (!names_.displacement.empty())
    for (const auto& plate : state.plates)
      for (const double each : plate.De) result.all[at++] = each;
  if (!names_.crack.empty())
    for (VectorXd CrackState::*factor : {&CrackState::K_I, &CrackState::K_II})
      for (const auto& plate : state.plates)
        for (const double each : plate.cracks.*factor) result.all[at++] = each;
  if (!result.all.allFinite()) return nothing(SampleStatus::out_of_balance);
  result.c = step.c;
  return result;
}

SampleNumbers StudySolver::solve(const Parameters& parameters, const VectorXd& away) const {
  try {
    const JointEquations equations = make_equations(joint_, system_, parameters, rims_);
    if (start_ && planes_that_may_snap(equations).empty()) {  // else the solution depends on the path
      Walk walk(equations, options_);
      const double load_factor = load_factors_.back();
      if (away.size() > 0 && walk.jump({load_factor, *start_ + away})) return numbers(equations, walk.step());
      if (walk.jump({load_factor, *start_})) return numbers(equations, walk.step());
    }
    const auto step = last_step(equations, load_factors_, options_);
    return step ? numbers(equations, *step) : nothing(SampleStatus::not_solved);
  } catch (const NumericalError&) {
    return nothing(SampleStatus::not_solved);
  }
}

}  // namespace fastjoint::stage3
