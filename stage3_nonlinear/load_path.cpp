// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/load_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stage3_nonlinear/first_guess.hpp"
#include "stage3_nonlinear/hybrid_solver.hpp"
#include "stage3_nonlinear/linear_joint.hpp"
#include "stage3_nonlinear/newton_solver.hpp"

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
      : equations_(equations), options_(options), scale_(scale) {
    here_ = {0, VectorXd::Zero(equations.n_fasteners())};
  }

  /// Goes to a load factor, in half steps if it must; false if that failed too.
  bool reach(double target) {
    iterations_ = 0;
    return advance(target, max_halvings);
  }

  [[nodiscard]] PathStep step() const {
    const auto state = contact_state(equations_.contacts, here_.c);
    const VectorXd r = equations_.system.residual(state.F, state.delta, here_.load_factor);
    return {here_.load_factor,   state.F,
            state.delta,         iterations_,
            largest(r) / scale_, undetermined(equations_.system, state)};
  }

  [[nodiscard]] PathFailure failure(std::size_t increment, double load_factor) const {
    return {increment, load_factor, here_.load_factor, worst_fastener_, worst_residual_};
  }

 private:
  bool advance(double target, int halvings_left) {
    if (solve(target)) return true;
    if (halvings_left == 0) return false;
    const double middle = 0.5 * (here_.load_factor + target);
    return advance(middle, halvings_left - 1) && advance(target, halvings_left - 1);
  }

  bool solve(double target) {
    if (target == 0) {  // without load the joint as it was built is in equilibrium, exactly
      here_ = {0, VectorXd::Zero(equations_.n_fasteners())};
      return true;
    }
    worst_residual_ = std::numeric_limits<double>::infinity();
    const auto problem = scaled_problem(target);
    const auto solved_by = [&](decltype(&hybrid_root) solver) {
      return [this, &problem, target, solver](const VectorXd& start) {
        return solve_from(start, target, problem, solver);
      };
    };
    const bool started = here_.load_factor != 0;
    if (started && solved_by(hybrid_root)(here_.c)) return true;
    auto starts = first_guesses(equations_, options_.initial, target);
    if (std::any_of(starts.begin(), starts.end(), solved_by(hybrid_root))) return true;
    starts.insert(starts.begin(), here_.c);
    return std::any_of(starts.begin(), starts.end(), solved_by(newton_root));
  }

  /// Unknowns and residuals over the largest force.
  [[nodiscard]] RootProblem scaled_problem(double target) const {
    const auto residual = [this, target](const VectorXd& x) -> VectorXd {
      const auto state = contact_state(equations_.contacts, scale_ * x);
      return equations_.system.residual(state.F, state.delta, target) / scale_;
    };
    const auto jacobian = [this](const VectorXd& x) {
      // A trace of stiffness for open fasteners, in the direction of search only: a sheet that none of them
      // touches has no other, and the solvers divide by what is left.
      constexpr double trace = 1e-9;
      auto state = contact_state(equations_.contacts, scale_ * x);
      state.dF = (state.dF.array() == 0).select(trace, state.dF);
      return tangent(equations_.system, state);
    };
    return {residual, jacobian};
  }

  bool solve_from(const VectorXd& start, double target, const RootProblem& problem, decltype(&hybrid_root) solver) {
    const Root root = solver(problem, start / scale_, {options_.solver.tolerance, options_.solver.max_iterations});
    iterations_ += root.iterations;
    if (!root.converged) {
      note_failure(root.residual);
      return false;
    }
    const VectorXd c = scale_ * root.x;
    if (const auto spent = contact_state(equations_.contacts, c).spent) {
      if (std::isinf(worst_residual_)) worst_fastener_ = *spent;
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
    worst_fastener_ = at;
  }

  const JointEquations& equations_;
  const PathOptions& options_;
  double scale_;
  State here_;
  int iterations_ = 0;
  double worst_residual_ = 0;
  Index worst_fastener_ = 0;
};

/// Solutions for load factors 1 and -1 serve all others: with friction the two senses differ.
std::optional<LoadPath> follow_linear(const JointEquations& equations, const std::vector<double>& load_factors,
                                      double tolerance) {
  const auto flexibility = linear_flexibility(equations.contacts);
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
    path.steps.push_back({factor, F, delta, forces->solves, residual, {}});
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
