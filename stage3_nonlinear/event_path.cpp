// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/event_path.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "stage3_nonlinear/event_search.hpp"
#include "stage3_nonlinear/linear_joint.hpp"
#include "stage3_nonlinear/piecewise_joint.hpp"
#include "stage3_nonlinear/walk.hpp"

namespace fastjoint::stage3 {
namespace {

/// Between the middles of neighbouring pieces, short ones left out: corners within rounding are one event.
std::vector<EventPlace> events_of(const ExactPath& path, const ContactMarks& marks) {
  constexpr double shortest = 1e-10;
  std::vector<EventPlace> events;
  std::optional<Eigen::VectorXi> before;
  double load = 0;
  for (const auto& piece : path.pieces) {
    if (piece.end - piece.begin <= shortest * path.reach()) continue;
    const Eigen::VectorXi here = marks.stages(path.at(0.5 * (piece.begin + piece.end)));
    if (before && here != *before) {
      EventPlace& event = events.emplace_back();
      event.place.load_factor = load;
      event.place.c = path.at(load);
      event.place.exact = true;
      event.iterations = static_cast<int>(path.piece_of(load)) + 1;
      event.events = marks.between(*before, here);
    }
    before = here;
    load = piece.end;
  }
  return events;
}

LoadPath path_through(const std::vector<EventPlace>& events, Walk& walk, double scale) {
  LoadPath path{.force_scale = scale, .steps = {}, .failure = {}};
  for (const auto& event : events) {
    walk.put(event.place, event.iterations);
    path.steps.push_back(walk.step());
    path.steps.back().events = event.events;
  }
  return path;
}

}  // namespace

LoadPath follow_events(const JointEquations& equations, const PathOptions& options) {
  const std::vector<double> end{1};
  if (linear_flexibility(equations)) return follow(equations, end, options);
  const double scale = force_scale(equations.system, end);
  const ContactMarks marks(equations.contacts);
  std::vector<EventPlace> events;
  std::optional<double> failed;
  std::vector<ExactPath> exact;
  if (may_be_exact(options.solver.method) && is_piecewise_linear(equations)) exact.push_back(exact_path(equations, 1));
  Walk walk(equations, options, scale, exact);
  if (!exact.empty() && exact[0].reach() >= 1) {
    events = events_of(exact[0], marks);
  } else {
    failed = search_events(equations, options, marks, scale, walk, events);
  }
  std::optional<PathFailure> failure;
  if (failed) failure = walk.failure(events.size(), *failed);
  LoadPath path = path_through(events, walk, scale);
  path.n_increments = events.size() + 1;
  path.failure = failure;
  if (failed) return path;
  constexpr double at_end = 1 - 1e-10;
  if (!events.empty() && events.back().place.load_factor >= at_end) {
    --path.n_increments;
  } else if (walk.reach(1)) {
    path.steps.push_back(walk.step());
  } else {
    path.failure = walk.failure(events.size(), 1);
  }
  return path;
}

}  // namespace fastjoint::stage3
