// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "common/program/progress.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {

LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors, const PathOptions& options) {
  LoadPath path{.n_increments = std::ssize(load_factors), .steps = {}, .failure = {}};
  Walk walk(equations, options);
  path.assembled = walk.assemble();
  const ContactCorners corners(equations);
  Eigen::VectorXi passed = corners.passed(walk.here().c);
  for (Index i = 0; i < std::ssize(load_factors); ++i) {
    program::report_share(double(i) / double(load_factors.size()));
    const VectorXd before = walk.here().c;
    if (!walk.reach(load_factors[i])) {
      path.failure = walk.failure(i, load_factors[i]);
      break;
    }
    if (!walk.record(path, corners.at(before, passed, walk.here().c))) break;
    passed = corners.passed(walk.here().c);
  }
  path.left = walk.left();
  return path;
}

std::vector<LoadPath> follow_segments(const JointModel& joint, const std::shared_ptr<const CondensedSystem>& system,
                                      const Parameters& parameters, const std::vector<Segment>& segments,
                                      PathOptions options) {
  std::vector<LoadPath> paths;
  VectorXd before = VectorXd::Zero(parameters.load.size());
  for (const Segment& segment : segments) {
    Parameters its = parameters;
    its.load = segment.load - before;
    if (!before.isZero(0)) its.load_before = before;
    JointEquations equations = make_equations(joint, system, std::move(its));
    if (!paths.empty()) equations.history = paths.back().history;
    paths.push_back(segment.load_factors.empty() ? follow_events(equations, options)
                                                 : follow(equations, segment.load_factors, options));
    if (paths.back().failure || paths.back().steps.empty()) break;
    const PathStep& last = paths.back().steps.back();
    before += last.load_factor * (segment.load - before);
    options.start = last.c;
  }
  return paths;
}

}  // namespace fastjoint::stage3
