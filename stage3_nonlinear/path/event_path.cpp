// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/program/progress.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/touch_search.hpp"
#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXi;

constexpr double together = 1e-9;           // events whose load factors differ by less are one
constexpr double touching_together = 1e-6;  // the same for touching rims, which are known to a millionth of their gap
constexpr int max_halvings_in_doubt = 4;
constexpr int max_halvings_for_certain = 30;

/// State with its events.
struct EventPlace {
  Place place;
  int iterations = 0;
  std::vector<ContactEvent> events = {};
};

/// Appends events; those within `together` of the last state are added to it.
void add(std::vector<EventPlace>& to, const Place& place, int iterations, const std::vector<ContactEvent>& events) {
  if (to.empty() || place.load_factor - to.back().place.load_factor > together) to.push_back({place, iterations});
  to.back().events.insert(to.back().events.end(), events.begin(), events.end());
}

/// Result of a search.
struct FoundEvents {
  std::vector<EventPlace> events;  ///< ascending
  std::optional<double> failed;    ///< a load factor that could not be reached; the events are those before it
};

/// Search for events from first_load_factor on, by states that a walk solves.
class Search {
 public:
  Search(const JointEquations& equations, const ContactCorners& corners, Walk& walk)
      : equations_(equations), corners_(corners), walk_(walk), touches_(equations, corners) {}

  /// @param loads Load factors that are solved first, ascending; the search ends at the last.
  FoundEvents run(const std::vector<double>& loads) {
    const auto first = solved(first_load_factor);
    if (!first) return std::move(found_);
    Sample here = *first;
    for (const double load : loads) {
      const auto next = solved(load);
      if (!next) search_below_limit(here, load);
      if (!next || !between(here, *next, 0)) break;
      walk_.put({next->load, next->c}, 0, Place{here.load, here.c});
      here = *next;
    }
    return std::move(found_);
  }

 private:
  /// Finds the events between a state and the last one that was solved on the way to a load that the joint does not
  /// reach, such as that just below its limit load.
  void search_below_limit(const Sample& here, double failed) {
    const Place last = walk_.here();
    if (!(last.load_factor > here.load)) return;
    (void)between(here, {last.load_factor, last.c, corners_.passed(last.c)}, 0);
    walk_.put(last, 0);
    found_.failed = failed;
  }

  std::optional<Sample> solved(double load) {
    program::report_share(load);
    if (walk_.reach(load)) return Sample{load, walk_.here().c, corners_.passed(walk_.here().c)};
    found_.failed = load;
    return std::nullopt;
  }

  /// Finds the events between two states; false if a state between cannot be solved.
  bool between(const Sample& a, const Sample& b, int depth) {
    if (b.load - a.load <= (touches_.make_the_difference(a, b) ? touching_together : together))
      return note_unresolved(a, b);
    if (a.passed == b.passed) {
      const bool doubtful = depth < max_halvings_in_doubt && points_beyond_a_corner(a, b);
      return !doubtful || halve(a, b, depth);
    }
    if (const auto first = first_crossing(a, b)) {
      const auto& [load, c] = first->place;
      if (!between(a, {load, c, a.passed}, depth + 1)) return false;
      const Sample after{load, c, passed_after(a, b, c)};
      add(found_.events, first->place, first->iterations, corners_.between(a.passed, after.passed));
      return between(after, b, depth);
    }
    return depth < max_halvings_for_certain ? halve(a, b, depth) : note_unresolved(a, b);
  }

  bool halve(const Sample& a, const Sample& b, int depth) {
    const double load = touches_.place_between(a, b).value_or(0.5 * (a.load + b.load));
    const Sample& nearer = load - a.load < b.load - load ? a : b;
    const Sample& further = &nearer == &a ? b : a;
    walk_.put({nearer.load, nearer.c}, 0, Place{further.load, further.c});
    const auto middle = solved(load);
    return middle && between(a, *middle, depth + 1) && between(*middle, b, depth + 1);
  }

  /// Adds the events between two states that are too close for a search to the second state.
  bool note_unresolved(const Sample& a, const Sample& b) {
    if (a.passed != b.passed) add(found_.events, {b.load, b.c}, 0, corners_.between(a.passed, b.passed));
    return true;
  }

  /// Coordinate of the next corner of a plane that has passed `from` corners and will have passed `to` of them; the
  /// coordinate has a sign where planes bear both ways.
  [[nodiscard]] double next_corner(Index plane, int from, int to) const {
    const bool up = to > from;
    const int number = up ? (from >= 0 ? from + 1 : from) : (from > 0 ? from : from - 1);
    return std::copysign(corners_.of(plane)[std::abs(number) - 1].at, number);
  }

  /// Solves for the load factor and all c with one plane on a corner.
  [[nodiscard]] std::optional<EventPlace> crossing(const Sample& a, const Sample& b, Index plane, double corner) const {
    // The position of a bolt without load is indeterminate, so that only solved states show where it touches.
    if (corners_.of(plane).front().kind == CornerKind::touch) return std::nullopt;
    const Index rows = equations_.n_unknowns();
    double unit = 1;
    RootProblem problem;
    problem.residual = [&](const VectorXd& x) -> VectorXd {
      VectorXd r(rows + 1);
      r << root_problem(equations_, x[rows], unit).residual(x.head(rows)),
          (corners_.position(unit * x.head(rows), plane) - corner) / unit;
      return r;
    };
    problem.jacobian = [&](const VectorXd& x) -> MatrixXd {
      MatrixXd J = MatrixXd::Zero(rows + 1, rows + 1);
      J.topLeftCorner(rows, rows) = root_problem(equations_, x[rows], unit).jacobian(x.head(rows));
      J.col(rows).head(rows) = -equations_.q_at(x[rows]) / unit;
      J.row(rows).head(rows) = corners_.slope(unit * x.head(rows), plane);
      return J;
    };
    const double from = corners_.position(a.c, plane), to = corners_.position(b.c, plane);
    const double fraction = from == to ? 0.5 : std::clamp((corner - from) / (to - from), 0.0, 1.0);
    VectorXd c = (1 - fraction) * a.c + fraction * b.c;
    if (corners_.slope(c, plane).isZero(0)) return std::nullopt;
    constexpr double tolerance = 1e-13, enough = 1e-11;
    constexpr int max_iterations = 60;
    double load = (1 - fraction) * a.load + fraction * b.load;
    int iterations = 0;
    for (const bool again : {false, true}) {  // relative to the full load, then if necessary to its own
      unit =
          again ? force_scale(equations_, load) : std::max(force_scale(equations_, 1), force_scale(equations_, a.load));
      VectorXd start(rows + 1);
      start << c / unit, load;
      const Root root = newton_root(problem, start, {again ? enough : tolerance, max_iterations});
      if (!(root.residual.lpNorm<Eigen::Infinity>() <= enough)) {
        if (again) break;
        return std::nullopt;
      }
      c = unit * root.x.head(rows);
      load = root.x[rows];
      iterations += root.iterations;
    }
    const Index n_directions = plane < equations_.n_planes() ? equations_.n_directions() : 0;
    if (n_directions == 1) c[plane] = corner;  // exactly: then nothing bears yet
    // A magnitude is rounded to beyond the corner, to the side of more bearing.
    if (n_directions > 1) {
      constexpr double beyond = 1 + 4 * std::numeric_limits<double>::epsilon();
      c.segment(plane * n_directions, n_directions) *= beyond * corner / corners_.position(c, plane);
    }
    return EventPlace{{load, std::move(c)}, iterations};
  }

  /// The first crossing between two states, if one is found. Planes are tried in the order in which straight lines
  /// between the states meet their corners.
  [[nodiscard]] std::optional<EventPlace> first_crossing(const Sample& a, const Sample& b) const {
    std::vector<std::pair<double, Index>> planes;  // fraction of the way to the corner, and the plane
    for (Index j = 0; j < std::ssize(a.passed); ++j) {
      if (a.passed[j] == b.passed[j]) continue;
      const double from = corners_.position(a.c, j), to = corners_.position(b.c, j);
      planes.emplace_back(from == to ? 0.5 : (next_corner(j, a.passed[j], b.passed[j]) - from) / (to - from), j);
    }
    std::ranges::sort(planes);
    constexpr std::size_t max_tries = 3;
    for (std::size_t i = 0; i < std::min(max_tries, planes.size()); ++i) {
      const Index j = planes[i].second;
      const double corner = next_corner(j, a.passed[j], b.passed[j]);
      auto found = crossing(a, b, j, corner);
      const double at_start = is_on(a.c, j, corner) ? together : -together;
      if (!found || found->place.load_factor < a.load + at_start || found->place.load_factor > b.load + together)
        continue;
      if (is_first(a, b, found->place.c)) return found;
    }
    return std::nullopt;
  }

  /// Tells whether no plane passes a corner before a crossing, other than those that are on their corner there.
  [[nodiscard]] bool is_first(const Sample& a, const Sample& b, const VectorXd& c) const {
    if (contact_state(equations_, c).failed) return false;
    const VectorXi here = corners_.passed(c);
    for (Index j = 0; j < std::ssize(here); ++j) {
      const bool passes = a.passed[j] != b.passed[j] && is_on(c, j, next_corner(j, a.passed[j], b.passed[j]));
      if (here[j] != a.passed[j] && !passes) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_on(const VectorXd& c, Index plane, double corner) const {
    return std::abs(corners_.position(c, plane) - corner) <= corners_.nearness(c, std::abs(corner));
  }

  /// Corners passed just after a crossing: all planes that are on the corner they pass have passed it.
  [[nodiscard]] VectorXi passed_after(const Sample& a, const Sample& b, const VectorXd& c) const {
    VectorXi passed = a.passed;
    for (Index j = 0; j < std::ssize(passed); ++j)
      if (passed[j] != b.passed[j] && is_on(c, j, next_corner(j, passed[j], b.passed[j])))
        passed[j] += b.passed[j] > passed[j] ? 1 : -1;
    return passed;
  }

  /// Tells whether a plane may pass a corner and return between two states that have passed the same corners, by the
  /// cubic through its coordinates and their rates at both.
  [[nodiscard]] bool points_beyond_a_corner(const Sample& a, const Sample& b) const {
    const double length = b.load - a.load;
    const VectorXd rate_a = length * rate(equations_, a), rate_b = length * rate(equations_, b);
    if (!rate_a.allFinite() || !rate_b.allFinite()) return false;
    for (const double t : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      const double s = 1 - t;
      const VectorXd c = s * s * (1 + 2 * t) * a.c + t * t * (1 + 2 * s) * b.c + s * t * (s * rate_a - t * rate_b);
      const VectorXi there = corners_.passed(c);
      for (Index j = 0; j < std::ssize(there); ++j)
        if (there[j] != a.passed[j] && !is_on_a_corner(a.c, j) && !is_on_a_corner(b.c, j)) return true;
    }
    return false;
  }

  /// Tells whether a plane is on a corner, where its rate is that of one side only.
  [[nodiscard]] bool is_on_a_corner(const VectorXd& c, Index plane) const {
    const auto& own = corners_.of(plane);
    return std::ranges::any_of(
        own, [&](const Corner& corner) { return is_on(c, plane, corner.at) || is_on(c, plane, -corner.at); });
  }

  const JointEquations& equations_;
  const ContactCorners& corners_;
  Walk& walk_;
  FoundEvents found_;
  TouchSearch touches_;
};

}  // namespace

LoadPath follow_events(const JointEquations& equations, const PathOptions& options) {
  constexpr double at_end = 1 - 1e-10;
  LoadPath path{.n_increments = 1, .steps = {}, .failure = {}};
  Walk walk(equations, options);
  const ContactCorners corners(equations);
  if (!walk.start(path)) return path;
  constexpr int intervals = 8;
  std::vector<double> loads;
  for (int i = 1; i <= intervals; ++i) loads.push_back(double(i) / intervals);
  const auto [events, failed] = Search(walk.equations(), corners, walk).run(loads);
  const bool ends_there = !failed && !events.empty() && events.back().place.load_factor >= at_end;
  path.n_increments = events.size() + (ends_there ? 0 : 1);
  if (failed) path.failure = walk.failure(events.size(), *failed);
  path.left = walk.left();
  const bool remembers = equations.remembers();
  for (Index i = 0; i < std::ssize(events); ++i) {
    auto event = events[i];
    walk.put(event.place, event.iterations);
    corners.leave_to_memory(event.events, false);
    if (remembers) {  // solve it with what it has kept of the increments before
      if (!walk.reach(event.place.load_factor)) {
        path.failure = walk.failure(i, event.place.load_factor);
        return path;
      }
      walk.put(walk.here(), event.iterations);
    }
    if (!walk.record(path, event.events)) return path;
  }
  if (failed || ends_there) return path;
  if (!walk.reach(1)) {
    path.failure = walk.failure(std::ssize(events), 1);
  } else {
    walk.record(path, {});
  }
  path.left = walk.left();
  return path;
}

std::optional<Interference> search_interference(const JointEquations& equations, const PathOptions& options,
                                                const LoadPath& path) {
  if (!path.assembled) return std::nullopt;
  const ContactCorners corners(equations, true);
  std::vector<double> loads;  // the maxima of the load factor along the path
  for (const auto& step : path.steps)
    if (step.load_factor > (loads.empty() ? first_load_factor : loads.back())) loads.push_back(step.load_factor);
  Interference result{VectorXd(std::ssize(equations.rims)), loads.empty() ? 0 : loads.back()};
  result.lost.setConstant(std::numeric_limits<double>::infinity());
  if (loads.empty()) return result;
  PathOptions from_there = options;
  from_there.start = path.assembled;
  Walk walk(equations, from_there);
  walk.reach(first_load_factor);
  const VectorXi parted = corners.passed(walk.here().c);
  const auto found = Search(walk.equations(), corners, walk).run(loads);
  if (found.failed) result.followed = found.events.empty() ? 0 : found.events.back().place.load_factor;
  for (auto event = found.events.rbegin(); event != found.events.rend(); ++event)
    for (const auto& each : event->events)
      if (!each.back) result.lost[(each.plane - equations.n_planes()) / 2] = event->place.load_factor;
  for (Index i = 0; i < result.lost.size(); ++i)
    if (parted[equations.n_planes() + 2 * i + 1] != 0) result.lost[i] = 0;
  return result;
}

}  // namespace fastjoint::stage3
