// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/event_path.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "stage3_nonlinear/equations/linear_joint.hpp"
#include "stage3_nonlinear/equations/piecewise_joint.hpp"
#include "stage3_nonlinear/path/event_search.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"

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

/// Those of the exact path if it reaches the full load, else what a search by `walk` finds.
FoundEvents find_events(const JointEquations& equations, const std::vector<ExactPath>& exact, Walk& walk) {
  const ContactMarks marks(equations.contacts);
  if (!exact.empty() && exact[0].reach() >= 1) return {events_of(exact[0], marks), std::nullopt};
  return search_events(equations, marks, walk);
}

}  // namespace

LoadPath follow_events(const JointEquations& equations, const PathOptions& options) {
  constexpr double at_end = 1 - 1e-10;
  const std::vector<double> end{1};
  if (linear_flexibility(equations)) return follow(equations, end, options);
  LoadPath path{.steps = {}, .failure = {}};
  std::vector<ExactPath> exact;
  if (may_be_exact(options.solver.method) && is_piecewise_linear(equations)) exact.push_back(exact_path(equations, 1));
  Walk walk(equations, options, exact);
  const auto [events, failed] = find_events(equations, exact, walk);
  if (failed) path.failure = walk.failure(events.size(), *failed);
  for (const auto& event : events) {
    walk.put(event.place, event.iterations);
    path.steps.push_back(walk.step());
    path.steps.back().events = event.events;
  }
  path.left = walk.left();
  const bool ends_there = !failed && !events.empty() && events.back().place.load_factor >= at_end;
  path.n_increments = events.size() + (ends_there ? 0 : 1);
  if (failed || ends_there) return path;
  if (walk.reach(1)) {
    path.steps.push_back(walk.step());
    path.left = walk.left();
  } else {
    path.failure = walk.failure(events.size(), 1);
  }
  return path;
}

}  // namespace fastjoint::stage3
