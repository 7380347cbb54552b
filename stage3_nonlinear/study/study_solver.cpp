// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_solver.hpp"

#include <utility>

#include "common/errors.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {

CaseSolver::CaseSolver(const JointModel& joint, const JointScene& scene, std::size_t at,
                       std::shared_ptr<const CondensedSystem> system)
    : joint_(joint),
      at_(at),
      load_factor_(scene.cases[at].wanted_load_factors().back()),
      has_path_(scene.cases[at].after || scene.cases[at].wanted_load_factors().size() > 1),
      options_{scene.initial, scene.solver},
      system_(std::move(system)) {
  rims_ = equations_of(scene, at).rims;
  std::vector<History> none;
  middle_ = from_no_load(scene, none);
  if (!middle_) return;
  const JointEquations equations = equations_of(scene, at);
  (void)contact_state(equations, middle_->c);
  rims_ = equations.rims;  // samples start at these solutions
}

JointEquations CaseSolver::equations_of(const JointScene& scene, std::size_t at) const {
  Parameters parameters = parameters_of(joint_, scene, scene.cases[at]);
  VectorXd before = VectorXd::Zero(parameters.load.size());
  for (auto its = scene.cases[at].after; its; its = scene.cases[*its].after)
    before += scene.cases[*its].wanted_load_factors().back() * parameters_of(joint_, scene, scene.cases[*its]).load;
  if (!before.isZero(0)) parameters.load_before = std::move(before);
  return make_equations(joint_, system_, std::move(parameters), rims_);
}

std::optional<PathStep> CaseSolver::from_middle(const JointEquations& equations, const VectorXd& away) const {
  if (!middle_ || !planes_that_may_snap(equations).empty()) return std::nullopt;  // the solution depends on the path
  if ((has_path_ || !equations.starts_unloaded()) && equations.remembers()) return std::nullopt;
  Walk walk(equations, options_);
  if ((away.size() > 0 && walk.jump({load_factor_, middle_->c + away})) || walk.jump({load_factor_, middle_->c}))
    return walk.step();
  return std::nullopt;
}

std::optional<PathStep> CaseSolver::from_no_load(const JointScene& scene, std::vector<History>& history) const {
  std::vector<std::size_t> chain{at_};
  while (scene.cases[chain.back()].after) chain.push_back(*scene.cases[chain.back()].after);
  PathOptions options = options_;
  LoadPath path;
  for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
    JointEquations equations = equations_of(scene, *at);
    equations.history = std::move(path.history);
    path = {};
    Walk walk(equations, options);
    if (!walk.start(path)) return std::nullopt;
    for (const double factor : scene.cases[*at].wanted_load_factors()) {
      history = walk.equations().history;
      if (!walk.reach(factor) || !walk.record(path, {})) return std::nullopt;
    }
    options.start = path.steps.back().c;
  }
  return std::move(path.steps.back());
}

StudySolver::StudySolver(const JointModel& joint, const JointScene& scene, const std::vector<std::size_t>& cases,
                         StudyOutputs outputs)
    : joint_(joint), bending_(joint, scene), tolerance_(scene.solver.tolerance), outputs_(std::move(outputs)) {
  const Held held = parameters_of(joint, scene, scene.cases[cases.front()]).held;
  const auto system = std::make_shared<const CondensedSystem>(condense(joint, held));
  for (const std::size_t at : cases) cases_.emplace_back(joint, scene, at, system);
  middle_ = solve(scene);
}

VectorXd StudySolver::numbers(const JointEquations& equations, const PathStep& step,
                              const std::string& case_name) const {
  JointState state = joint_state(joint_, equations, step);
  if (imbalance(equations, step, state, tolerance_)) return nothing(SampleStatus::out_of_balance).all;
  if (outputs_.need_bending()) bending_.add(SolvedPoint(equations, step.load_factor, step.c), step, state);
  VectorXd all = outputs_.numbers({joint_, equations, step, state, 0}, case_name);
  if (state.no_bending != nullptr && all.array().isNaN().any()) throw NumericalError(state.no_bending);
  return all;
}

SampleNumbers StudySolver::solve(const JointScene& scene, const VectorXd& away) const {
  try {
    SampleNumbers result;
    for (Index i = 0; i < std::ssize(cases_); ++i) {
      const Index r = away.size() / std::ssize(cases_);
      const bool solved = cases_[i].solve(scene, away.segment(i * r, r), [&](const auto& equations, const auto& step) {
        const VectorXd its = numbers(equations, step, scene.cases[cases_[i].at()].name);
        if (its.array().isNaN().any()) result.status = SampleStatus::out_of_balance;
        if (i == 0)
          result.all = its;
        else
          outputs_.take(its, result.all);
        result.c.conservativeResize((i + 1) * step.c.size());
        result.c.tail(step.c.size()) = step.c;
      });
      if (!solved) return nothing(SampleStatus::not_solved);
    }
    return result.status == SampleStatus::solved ? result : nothing(result.status);
  } catch (const NumericalError&) {
    return nothing(SampleStatus::not_solved);
  }
}

}  // namespace fastjoint::stage3
