// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "stage3_nonlinear/first_guess.hpp"
#include "stage3_nonlinear/newton_solver.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::VectorXd;

double force_scale(const CondensedSystem& system, const std::vector<double>& load_factors) {
  double factor = 0;
  for (const double each : load_factors) factor = std::max(factor, std::abs(each));
  const double scale = factor * system.q.lpNorm<Eigen::Infinity>();
  return scale > 0 ? scale : 1;
}

Walk::Walk(const JointEquations& equations, const PathOptions& options, double scale, std::vector<ExactPath> exact)
    : equations_(equations),
      options_(options),
      solver_(solver_named(iterative_method(options.solver.method))),
      scale_(scale),
      exact_(std::move(exact)),
      here_{0, VectorXd::Zero(equations.n_unknowns())} {}

bool Walk::reach(double target) {
  iterations_ = 0;
  return advance(target, max_halvings);
}

void Walk::put(Place place, int iterations) {
  here_ = std::move(place);
  iterations_ = iterations;
}

PathStep Walk::step() const {
  const auto state = contact_state(equations_.contacts, here_.c);
  const VectorXd r = equations_.system.residual(state.F, state.delta, here_.load_factor);
  return {.load_factor = here_.load_factor,
          .F = state.F,
          .delta = state.delta,
          .iterations = iterations_,
          .residual = r.lpNorm<Eigen::Infinity>() / scale_,
          .check = check_tangent(equations_, state),
          .exact = here_.exact};
}

PathFailure Walk::failure(std::size_t increment, double load_factor) const {
  return {increment,       load_factor,         here_.load_factor, worst_row_ / equations_.n_directions(),
          worst_residual_, locking(load_factor)};
}

std::optional<double> Walk::locking(double load_factor) const {
  const auto last = self_locking(equations_.system, contact_state(equations_.contacts, here_.c).F);
  const auto rigid = self_locking(equations_.system, load_factor * equations_.system.q);
  return last && rigid ? std::min(*last, *rigid) : last ? last : rigid;
}

bool Walk::advance(double target, int halvings_left) {
  if (solve(target)) return true;
  if (halvings_left == 0) return false;
  const double middle = 0.5 * (here_.load_factor + target);
  return advance(middle, halvings_left - 1) && advance(target, halvings_left - 1);
}

bool Walk::solve(double target) {
  if (target == 0) {  // without load the joint as it was built is in equilibrium, exactly
    here_ = {0, VectorXd::Zero(equations_.n_unknowns()), !exact_.empty()};
    return true;
  }
  if (take_exact(target)) return true;
  worst_residual_ = std::numeric_limits<double>::infinity();
  const auto problem = root_problem(equations_, target, scale_);
  const auto solved_by = [&](SolveFunction solver) {
    return
        [this, &problem, target, solver](const VectorXd& start) { return take(run(problem, start, solver), target); };
  };
  const bool started = here_.load_factor != 0;
  if (started && solved_by(solver_)(here_.c)) return true;
  auto starts = first_guesses(equations_, options_.initial, target);
  if (std::any_of(starts.begin(), starts.end(), solved_by(solver_))) return true;
  starts.insert(starts.begin(), here_.c);
  if (solver_ != newton_root && std::any_of(starts.begin(), starts.end(), solved_by(newton_root))) return true;
  return solve_by_turns(target, problem);
}

bool Walk::take_exact(double target) {
  for (const auto& path : exact_) {
    if (path.sign * target < 0 || std::abs(target) > path.reach()) continue;
    const VectorXd c = path.at(target);
    const auto state = contact_state(equations_.contacts, c);
    const VectorXd r = equations_.system.residual(state.F, state.delta, target);
    if (!(r.lpNorm<Eigen::Infinity>() <= options_.solver.tolerance * scale_)) return false;
    iterations_ += static_cast<int>(path.piece_of(target)) + 1;
    here_ = {target, c, true};
    return true;
  }
  return false;
}

/// Friction of the turn before as a load: each turn then has a solution that damped Newton finds, and the turns
/// converge where friction changes the forces by less than themselves.
bool Walk::solve_by_turns(double target, const RootProblem& problem) {
  constexpr int most_turns = 50;
  if (!equations_.system.has_friction() || equations_.metric.size() == 0) return false;
  VectorXd c = here_.c;
  for (int turn = 0; turn < most_turns; ++turn) {
    const VectorXd F = contact_state(equations_.contacts, c).F;
    const Root root = run(root_problem(equations_, target, scale_, &F), c, newton_root);
    if (!root.converged) return false;
    c = scale_ * root.x;
    if (take(run(problem, c, newton_root), target)) return true;
  }
  return false;
}

Root Walk::run(const RootProblem& problem, const VectorXd& start, SolveFunction solver) {
  Root root = solver(problem, start / scale_, {options_.solver.tolerance, options_.solver.max_iterations});
  iterations_ += root.iterations;
  return root;
}

bool Walk::take(const Root& root, double target) {
  if (!root.converged) {
    note_failure(root.residual);
    return false;
  }
  const VectorXd c = scale_ * root.x;
  if (const auto spent = contact_state(equations_.contacts, c).spent) {
    if (std::isinf(worst_residual_)) worst_row_ = *spent * equations_.n_directions();
    return false;
  }
  here_ = {target, c};
  return true;
}

/// Of all tries the one that came closest counts.
void Walk::note_failure(const VectorXd& residual) {
  Index at = 0;
  const double worst = residual.cwiseAbs().maxCoeff(&at);
  if (!(worst < worst_residual_)) return;
  worst_residual_ = worst;
  worst_row_ = at;
}

}  // namespace fastjoint::stage3
