// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/case_run.hpp"

#include <algorithm>
#include <utility>

namespace fastjoint::stage3 {

JointEquations CaseRun::equations(std::size_t at, const End* before) {
  Parameters parameters = parameters_of(joint_, scene_, scene_.cases[at]);
  if (!system_ || system_->held != parameters.held) {
    system_ = std::make_shared<const CondensedSystem>(condense(joint_, parameters.held));
    rims_.clear();  // their coordinates have the stiffness of the system before
  }
  if (before != nullptr && !before->load.isZero(0)) parameters.load_before = before->load;
  JointEquations result = make_equations(joint_, system_, std::move(parameters), rims_);
  if (before != nullptr) result.history = before->history;
  rims_ = result.rims;
  return result;
}

const CaseRun::End* CaseRun::end_of(std::size_t at, const PathOptions& options, const Wanted& wanted) {
  if (!ends_.contains(at)) {
    ends_[at];  // a case that fails leaves nothing
    (void)follow(at, scene_.cases[at].load_factors, options, {wanted.tolerance});
  }
  const auto& end = ends_.at(at);
  return end ? &*end : nullptr;
}

FollowedCase CaseRun::follow(std::size_t at, const std::vector<double>& load_factors, PathOptions options,
                             const Wanted& wanted) {
  const CaseScene& its = scene_.cases[at];
  const End* before = its.after ? end_of(*its.after, options, wanted) : nullptr;
  if (its.after && before == nullptr)
    return {.equations = equations(at, nullptr), .path = {}, .increments = {}, .missing = its.after};
  if (before != nullptr) options.start = before->c;
  JointEquations now = equations(at, before);
  auto [path, increments] = follow_with_results(joint_, now, load_factors, std::move(options), wanted);
  const bool is_needed = std::ranges::any_of(scene_.cases, [&](const auto& other) { return other.after == at; });
  if (is_needed && !path.failure && !path.steps.empty()) {
    const PathStep& last = path.steps.back();
    ends_[at] = End{now.parameters.given_at(last.load_factor), last.c, path.history};
  }
  return {std::move(now), std::move(path), std::move(increments)};
}

}  // namespace fastjoint::stage3
