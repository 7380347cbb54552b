// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/crack_errors.hpp"

#include <algorithm>
#include <limits>

#include "common/errors.hpp"
#include "stage3_nonlinear/results/crack_state.hpp"

namespace fastjoint::stage3 {
namespace {

/// True if all plates have a degree.
bool has_degree(const JointModel& joint, int p) {
  return std::ranges::all_of(joint.plates, [&](const PlateModel& plate) {
    return plate.degree == p || std::ranges::count(plate.lower, p, &PlateDegree::degree) > 0;
  });
}

/// States at the load factors of a case's path at another degree; empty if not all of them converge.
std::vector<JointState> states_at(CaseRun& other, std::size_t its_case, const LoadPath& path, PathOptions options,
                                  double tolerance) {
  std::vector<double> load_factors;
  for (const PathStep& step : path.steps) load_factors.push_back(step.load_factor);
  options.log = nullptr;
  try {
    auto followed = other.follow(its_case, load_factors, std::move(options), {tolerance});
    if (followed.increments.states.size() == path.steps.size()) return std::move(followed.increments.states);
  } catch (const NumericalError&) {  // then nothing is known of the errors
  }
  return {};
}

/// Errors of one factor of all tips at one increment.
/// @param sequence States of the plate, the lowest degree first.
VectorXd errors_of(const std::vector<const CrackState*>& sequence, VectorXd CrackState::*factor,
                   VectorXd CrackState::*by_waves) {
  const CrackState& last = *sequence.back();
  VectorXd errors = last.*by_waves;
  for (Index t = 0; t < errors.size(); ++t) {
    VectorXd values(std::ssize(sequence));
    for (Index i = 0; i < values.size(); ++i) values[i] = (sequence[i]->*factor)[t];
    errors[t] += geometric_error(values);
  }
  return errors;
}

}  // namespace

CrackErrorEstimate::CrackErrorEstimate(const JointScene& scene, const JointModel& joint)
    : tolerance_(scene.solver.tolerance) {
  if (std::ranges::all_of(joint.plates, [](const auto& plate) { return plate.cracks.tips.empty(); })) return;
  for (int p = joint.p - 1; p >= joint.p - 2 && has_degree(joint, p); --p) below_.emplace_back(scene, p);
}

std::vector<CrackErrors> CrackErrorEstimate::of(const JointModel& joint, std::size_t its_case, const LoadPath& path,
                                                const std::vector<JointState>& states, const PathOptions& options) {
  std::vector<CrackErrors> errors(joint.plates.size());
  const bool has_cracks =
      std::ranges::any_of(joint.plates, [](const auto& plate) { return !plate.cracks.tips.empty(); });
  if (!has_cracks || states.empty()) return errors;
  std::vector<std::vector<JointState>> below;  // of the lower degrees, the lowest first
  for (auto& degree : below_) {
    auto lower = states_at(degree.cases, its_case, path, options, tolerance_);
    if (lower.empty()) break;
    below.insert(below.begin(), std::move(lower));
  }
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const Index t = std::ssize(joint.plates[i].cracks.tips), n = std::ssize(states);
    errors[i] = {MatrixXd(n, t), MatrixXd(n, t)};
    for (Index step = 0; step < n; ++step) {
      std::vector<const CrackState*> sequence;
      for (const auto& lower : below) sequence.push_back(&lower[step].plates[i].cracks);
      sequence.push_back(&states[step].plates[i].cracks);
      errors[i].K_I.row(step) = errors_of(sequence, &CrackState::K_I, &CrackState::K_I_waves);
      errors[i].K_II.row(step) = errors_of(sequence, &CrackState::K_II, &CrackState::K_II_waves);
    }
  }
  return errors;
}

}  // namespace fastjoint::stage3
