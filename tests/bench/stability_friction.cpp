// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/stability_friction.hpp"

#include <fmt/format.h>

#include <iostream>
#include <random>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"

namespace fastjoint::bench {
namespace {

using Eigen::VectorXd;
using namespace stage3;

struct FrictionCounts {
  int solved = 0, from_far = 0, others = 0;
};

FrictionCounts solve_joints(int n, double mu) {
  constexpr double same = 1e-8, balanced = 1e-10;  // of the largest load
  std::mt19937 random(14);
  FrictionCounts counts;
  for (int i = 0; i < n; ++i) {
    const ContactKind kind{1 + i % 4, 1 + i % 2, i % 3 == 0, decades(random, 1e-4, 1e2), mu, i / 4 % 2 == 1};
    const JointEquations equations = make_equations(random_contact_joint(random, kind));
    const double scale = stage3::force_scale(equations, 1);
    const VectorXd far = VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return uniform(random, -10, 10); });
    const LoadPath path = follow(equations, {1}, {});
    const Root root = newton_root(root_problem(equations, 1, scale), far, {1e-12, 200});
    counts.solved += !path.failure;
    const bool from_far = root.residual.lpNorm<Eigen::Infinity>() < balanced;
    counts.from_far += from_far;
    if (path.failure || !from_far) continue;
    const VectorXd F = contact_state(equations, scale * root.x).F;
    counts.others += !((F - contact_state(equations, path.steps[0].c).F).lpNorm<Eigen::Infinity>() < same * scale);
  }
  return counts;
}

}  // namespace

bool chart_friction(int n) {
  std::cout << fmt::format(
      "| friction | of {} random joints solved from no load | by one Newton search from far away | with other forces "
      "from there |\n| --- | --- | --- | --- |\n",
      n);
  bool all = true;
  for (const double mu : {0.0, 0.15, 0.3, 0.6, 1.0, 2.0}) {
    const FrictionCounts counts = solve_joints(n, mu);
    std::cout << fmt::format("| {} | {} | {} | {} |\n", mu, counts.solved, counts.from_far, counts.others)
              << std::flush;
    all = all && counts.solved == n;
  }
  return all;
}

}  // namespace fastjoint::bench
