// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/stability_falling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "stage3_nonlinear/equations/stability.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/bench/stability_curves.hpp"

namespace fastjoint::bench {
namespace {

using Eigen::VectorXd;
using stage3::JointEquations;

double force_scale(const JointEquations& equations) { return equations.q.cwiseAbs().maxCoeff(); }

double residual_of(const JointEquations& equations, const VectorXd& F, const VectorXd& delta) {
  return VectorXd(F + equations.system->S_ud * delta - equations.q).cwiseAbs().maxCoeff() / force_scale(equations);
}

/// Forces of all solutions that random starts find, without failed fasteners.
std::vector<VectorXd> solutions(const JointEquations& equations, std::mt19937& random, double tolerance) {
  constexpr int starts = 100;
  constexpr double same = 1e-5;
  const double scale = force_scale(equations);
  const auto problem = root_problem(equations, 1, scale);
  std::vector<VectorXd> found;
  for (int i = 0; i < starts; ++i) {
    const VectorXd start = VectorXd::NullaryExpr(
        equations.n_unknowns(), [&] { return (chance(random, 0.5) ? 1 : -1) * decades(random, 1e-2, 1e2); });
    const auto root = (i % 2 == 0 ? stage3::hybridsj_root : stage3::newton_root)(problem, start, {tolerance, 200});
    if (!root.converged) continue;
    const auto state = contact_state(equations, scale * root.x);
    const auto equal = [&](const VectorXd& F) { return (F - state.F).cwiseAbs().maxCoeff() < same * scale; };
    if (!state.failed && std::none_of(found.begin(), found.end(), equal)) found.push_back(state.F);
  }
  return found;
}

/// Whether the solution balances with forces that the laws have at its displacements, none failed.
bool is_solution(const JointEquations& equations, const stage3::PathStep& step, double tolerance) {
  VectorXd c = step.delta;
  for (Eigen::Index j = 0; j < c.size(); ++j) {
    const auto& contact = equations.contacts[j];
    c[j] = contact.stiffness * step.delta[j] + (contact.law->rises() ? step.F[j] : 0);
  }
  const auto state = contact_state(equations, c);
  return !state.failed && residual_of(equations, state.F, state.delta) <= 10 * tolerance &&
         residual_of(equations, step.F, step.delta) <= tolerance;
}

}  // namespace

Falling check_falling(int n, double tolerance) {
  Falling result{.joints = n, .broken = {}};
  for (int i = 0; i < n; ++i) {
    const auto seed = static_cast<std::uint32_t>(i);
    const JointEquations equations = random_falling_joint(seed);
    const auto path = follow(equations, {1}, {});
    if (!path.failure) {
      ++result.solved;
      if (!is_solution(equations, path.steps[0], tolerance))
        result.broken.push_back(fmt::format("falling laws, seed {}: what the program returns is no solution", seed));
    }
    std::mt19937 random(seed);
    const auto n_found = solutions(equations, random, tolerance).size();
    if (path.failure && n_found > 0)
      result.broken.push_back(fmt::format("falling laws, seed {}: there is a solution, the program finds none", seed));
    if (n_found < 2) continue;
    ++result.several;
    const bool turned = !path.failure && path.steps[0].check.unstable > 0;
    const bool warned = !planes_that_may_snap(equations).empty() || turned;
    result.warned += warned;
    if (!warned) result.broken.push_back(fmt::format("falling laws, seed {}: several solutions, no warning", seed));
  }
  return result;
}

}  // namespace fastjoint::bench
