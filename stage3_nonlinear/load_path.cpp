// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/load_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stage3_nonlinear/first_guess.hpp"
#include "stage3_nonlinear/linear_joint.hpp"
#include "stage3_nonlinear/newton_solver.hpp"
#include "stage3_nonlinear/solver.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Largest |q| at the largest load factor; 1 if nothing reaches the fasteners.
double force_scale(const CondensedSystem& system, const std::vector<double>& load_factors) {
  double factor = 0;
  for (const double each : load_factors) factor = std::max(factor, std::abs(each));
  const double scale = factor * system.q.cwiseAbs().maxCoeff();
  return scale > 0 ? scale : 1;
}

double largest(const VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

struct State {
  double load_factor;
  VectorXd c;
};

/// One walk along the load factors: what has converged, and what it took.
class Walk {
 public:
  Walk(const JointEquations& equations, const PathOptions& options, double scale)
      : equations_(equations), options_(options), solver_(solver_named(options.solver.method)), scale_(scale) {
    here_ = {0, VectorXd::Zero(equations.n_unknowns())};
  }

  /// Goes to a load factor, in half steps if it must; false if that failed too.
  bool reach(double target) {
    iterations_ = 0;
    return advance(target, max_halvings);
  }

  [[nodiscard]] PathStep step() const {
    const auto state = contact_state(equations_.contacts, here_.c);
    const VectorXd r = equations_.system.residual(state.F, state.delta, here_.load_factor);
    return {
        here_.load_factor, state.F, state.delta, iterations_, largest(r) / scale_, check_tangent(equations_, state)};
  }

  [[nodiscard]] PathFailure failure(std::size_t increment, double load_factor) const {
    return {increment,       load_factor,         here_.load_factor, worst_row_ / directions(),
            worst_residual_, locking(load_factor)};
  }

 private:
  [[nodiscard]] Index directions() const {
    return equations_.n_unknowns() / static_cast<Index>(equations_.contacts.size());
  }

  /// On the sides that bear at the last load factor, or would with rigid fasteners without friction: the lower level.
  [[nodiscard]] std::optional<double> locking(double load_factor) const {
    const auto last = self_locking(equations_.system, contact_state(equations_.contacts, here_.c).F);
    const auto rigid = self_locking(equations_.system, load_factor * equations_.system.q);
    return last && rigid ? std::min(*last, *rigid) : last ? last : rigid;
  }

  bool advance(double target, int halvings_left) {
    if (solve(target)) return true;
    if (halvings_left == 0) return false;
    const double middle = 0.5 * (here_.load_factor + target);
    return advance(middle, halvings_left - 1) && advance(target, halvings_left - 1);
  }

  bool solve(double target) {
    if (target == 0) {  // without load the joint as it was built is in equilibrium, exactly
      here_ = {0, VectorXd::Zero(equations_.n_unknowns())};
      return true;
    }
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

  /// Friction of the turn before as a load: each turn then has a solution that damped Newton finds, and the turns
  /// converge where friction changes the forces by less than themselves.
  bool solve_by_turns(double target, const RootProblem& problem) {
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

  Root run(const RootProblem& problem, const VectorXd& start, SolveFunction solver) {
    Root root = solver(problem, start / scale_, {options_.solver.tolerance, options_.solver.max_iterations});
    iterations_ += root.iterations;
    return root;
  }

  bool take(const Root& root, double target) {
    if (!root.converged) {
      note_failure(root.residual);
      return false;
    }
    const VectorXd c = scale_ * root.x;
    if (const auto spent = contact_state(equations_.contacts, c).spent) {
      if (std::isinf(worst_residual_)) worst_row_ = *spent * directions();
      return false;
    }
    here_ = {target, c};
    return true;
  }

  /// Of all tries the one that came closest counts.
  void note_failure(const VectorXd& residual) {
    Index at = 0;
    const double worst = residual.cwiseAbs().maxCoeff(&at);
    if (!(worst < worst_residual_)) return;
    worst_residual_ = worst;
    worst_row_ = at;
  }

  const JointEquations& equations_;
  const PathOptions& options_;
  SolveFunction solver_;
  double scale_;
  State here_;
  int iterations_ = 0;
  double worst_residual_ = 0;
  Index worst_row_ = 0;
};

/// Solutions for load factors 1 and -1 serve all others: with friction the two senses differ.
std::optional<LoadPath> follow_linear(const JointEquations& equations, const std::vector<double>& load_factors,
                                      double tolerance) {
  const auto flexibility = linear_flexibility(equations);
  if (!flexibility) return std::nullopt;
  LoadPath path{.linear = true, .force_scale = force_scale(equations.system, load_factors), .steps = {}, .failure = {}};
  std::optional<LinearForces> unit[2];
  for (const double factor : load_factors) {
    auto& forces = unit[factor < 0 ? 1 : 0];
    if (!forces) forces = linear_forces(equations.system, *flexibility, factor < 0 ? -1 : 1);
    const VectorXd F = std::abs(factor) * forces->F;
    const VectorXd delta = flexibility->cwiseProduct(F);
    const double residual = largest(equations.system.residual(F, delta, factor)) / path.force_scale;
    if (!forces->consistent || !(residual <= tolerance)) return std::nullopt;
    const auto state = contact_state(equations.contacts, contact_coordinates(equations.contacts, F));
    path.steps.push_back({factor, F, delta, forces->solves, residual, check_tangent(equations, state)});
  }
  return path;
}

}  // namespace

LoadPath follow_nonlinear(const JointEquations& equations, const std::vector<double>& load_factors,
                          const PathOptions& options) {
  LoadPath path{.force_scale = force_scale(equations.system, load_factors), .steps = {}, .failure = {}};
  Walk walk(equations, options, path.force_scale);
  for (std::size_t i = 0; i < load_factors.size(); ++i) {
    if (!walk.reach(load_factors[i])) {
      path.failure = walk.failure(i, load_factors[i]);
      break;
    }
    path.steps.push_back(walk.step());
  }
  return path;
}

LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors, const PathOptions& options) {
  if (auto path = follow_linear(equations, load_factors, options.solver.tolerance)) return *std::move(path);
  return follow_nonlinear(equations, load_factors, options);
}

}  // namespace fastjoint::stage3
