// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/load_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stage3_nonlinear/equations/linear_joint.hpp"
#include "stage3_nonlinear/equations/piecewise_joint.hpp"
#include "stage3_nonlinear/path/exact_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;

/// Solutions for load factors 1 and -1 serve all others: with friction the two senses differ.
std::optional<LoadPath> follow_linear(const JointEquations& equations, const std::vector<double>& load_factors,
                                      double tolerance) {
  const auto flexibility = linear_flexibility(equations);
  if (!flexibility) return std::nullopt;
  LoadPath path{.linear = true, .n_increments = load_factors.size(), .steps = {}, .failure = {}};
  std::optional<LinearForces> unit[2];
  for (const double factor : load_factors) {
    auto& forces = unit[factor < 0 ? 1 : 0];
    if (!forces) forces = linear_forces(equations.system, *flexibility, factor < 0 ? -1 : 1);
    const VectorXd F = std::abs(factor) * forces->F;
    const VectorXd delta = flexibility->cwiseProduct(F);
    const double residual =
        equations.system.residual(F, delta, factor).lpNorm<Eigen::Infinity>() / force_scale(equations.system, factor);
    if (!forces->consistent || !(residual <= tolerance)) return std::nullopt;
    const auto state = contact_state(equations.contacts, contact_coordinates(equations.contacts, F));
    path.steps.push_back({factor, F, delta, forces->solves, residual, check_tangent(equations, state)});
  }
  return path;
}

/// One for each sign that the load factors have, as far as they go.
std::vector<ExactPath> exact_paths(const JointEquations& equations, const std::vector<double>& load_factors) {
  const auto [least, most] = std::minmax_element(load_factors.begin(), load_factors.end());
  std::vector<ExactPath> paths;
  if (*most > 0) paths.push_back(exact_path(equations, *most));
  if (*least < 0) paths.push_back(exact_path(equations, *least));
  return paths;
}

LoadPath walk_along(const JointEquations& equations, const std::vector<double>& load_factors,
                    const PathOptions& options, std::vector<ExactPath> exact) {
  LoadPath path{.n_increments = load_factors.size(), .steps = {}, .failure = {}};
  Walk walk(equations, options, std::move(exact));
  const ContactCorners corners(equations.contacts);
  for (std::size_t i = 0; i < load_factors.size(); ++i) {
    const VectorXd before = walk.here().c;
    if (!walk.reach(load_factors[i])) {
      path.failure = walk.failure(i, load_factors[i]);
      break;
    }
    path.steps.push_back(walk.step());
    path.steps.back().events = corners.at(before, walk.here().c);
  }
  path.left = walk.left();
  return path;
}

}  // namespace

LoadPath follow_nonlinear(const JointEquations& equations, const std::vector<double>& load_factors,
                          const PathOptions& options) {
  return walk_along(equations, load_factors, options, {});
}

LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors, const PathOptions& options) {
  if (auto path = follow_linear(equations, load_factors, options.solver.tolerance)) return *std::move(path);
  const bool exact = may_be_exact(options.solver.method) && is_piecewise_linear(equations);
  return walk_along(equations, load_factors, options,
                    exact ? exact_paths(equations, load_factors) : std::vector<ExactPath>{});
}

}  // namespace fastjoint::stage3
