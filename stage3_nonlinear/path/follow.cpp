// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "common/program/progress.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {

LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors, const PathOptions& options) {
  LoadPath path{.n_increments = std::ssize(load_factors), .steps = {}, .failure = {}};
  Walk walk(equations, options);
  if (!walk.start(path)) return path;
  const ContactCorners corners(equations);
  Eigen::VectorXi passed = corners.passed(walk.here().c);
  for (Index i = 0; i < std::ssize(load_factors); ++i) {
    program::report_share(double(i) / double(load_factors.size()));
    const VectorXd before = walk.here().c;
    if (!walk.reach(load_factors[i])) {
      path.failure = walk.failure(i, load_factors[i]);
      break;
    }
    auto events = corners.at(before, passed, walk.here().c);
    corners.leave_to_memory(events);
    if (!walk.record(path, std::move(events))) break;
    passed = corners.passed(walk.here().c);
  }
  path.left = walk.left();
  return path;
}

}  // namespace fastjoint::stage3
