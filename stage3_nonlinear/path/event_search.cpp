// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/event_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "stage3_nonlinear/solvers/newton_solver.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

constexpr double together = 1e-9;  // events whose load factors differ by less are one
constexpr int most_halvings_in_doubt = 4;
constexpr int most_halvings_for_certain = 30;

/// A solved state; its stages are those just behind it if it begins an interval.
struct Sample {
  double load;
  VectorXd c;
  VectorXi stages;
};

struct Crossing {
  double load;
  VectorXd c;
  int iterations;
};

class Search {
 public:
  Search(const JointEquations& equations, const ContactMarks& marks, Walk& walk)
      : equations_(equations), marks_(marks), walk_(walk) {}

  FoundEvents run() {
    constexpr int intervals = 8;
    const auto first = solved(first_load_factor);
    if (!first) return std::move(found_);
    Sample here = *first;
    for (int i = 1; i <= intervals; ++i) {
      const auto next = solved(static_cast<double>(i) / intervals);
      if (!next || !between(here, *next, 0)) break;
      walk_.put({next->load, next->c}, 0);
      here = *next;
    }
    return std::move(found_);
  }

 private:
  std::optional<Sample> solved(double load) {
    if (walk_.reach(load)) return Sample{load, walk_.here().c, marks_.stages(walk_.here().c)};
    found_.failed = load;
    return std::nullopt;
  }

  /// Finds what happens between two states; false if a state between cannot be solved.
  bool between(const Sample& a, const Sample& b, int depth) {
    if (b.load - a.load <= together) return note_unresolved(a, b);
    if (a.stages == b.stages) {
      const bool doubtful = depth < most_halvings_in_doubt && points_beyond_a_mark(a, b);
      return !doubtful || halve(a, b, depth);
    }
    if (const auto first = first_crossing(a, b)) {
      // Up to there the stages are those of a.
      if (!between(a, {first->load, first->c, a.stages}, depth + 1)) return false;
      const Sample behind{first->load, first->c, stages_behind(a, b, first->c)};
      note(behind.load, behind.c, first->iterations, marks_.between(a.stages, behind.stages));
      return between(behind, b, depth);
    }
    return depth < most_halvings_for_certain ? halve(a, b, depth) : note_unresolved(a, b);
  }

  bool halve(const Sample& a, const Sample& b, int depth) {
    walk_.put({a.load, a.c}, 0);
    const auto middle = solved(0.5 * (a.load + b.load));
    return middle && between(a, *middle, depth + 1) && between(*middle, b, depth + 1);
  }

  void note(double load, const VectorXd& c, int iterations, std::vector<ContactEvent> what) {
    EventPlace& event = found_.events.emplace_back();
    event.place.load_factor = load;
    event.place.c = c;
    event.iterations = iterations;
    event.events = std::move(what);
  }

  /// Too close to be told apart: what differs happens at the end.
  bool note_unresolved(const Sample& a, const Sample& b) {
    if (a.stages != b.stages) note(b.load, b.c, 0, marks_.between(a.stages, b.stages));
    return true;
  }

  /// The mark that a plane passes first on its way from stage to stage, signed where planes bear both ways.
  [[nodiscard]] double next_mark(Index plane, int from, int to) const {
    const bool up = to > from;
    const int number = up ? (from >= 0 ? from + 1 : from) : (from > 0 ? from : from - 1);
    return std::copysign(marks_.of(plane)[std::abs(number) - 1].at, number);
  }

  /// Solves for the load factor and all c with one plane on its mark.
  [[nodiscard]] std::optional<Crossing> crossing(const Sample& a, const Sample& b, Index plane, double mark) const {
    const Index n_directions = equations_.n_directions();
    const Index rows = equations_.n_unknowns();
    const auto own = Eigen::seqN(plane * n_directions, n_directions);
    const auto position = [&](const VectorXd& c) { return amounts(c(own), n_directions)[0]; };
    double unit = 1;
    RootProblem problem;
    problem.residual = [&](const VectorXd& x) -> VectorXd {
      VectorXd r(rows + 1);
      r << root_problem(equations_, x[rows], unit).residual(x.head(rows)), position(x.head(rows)) - mark / unit;
      return r;
    };
    problem.jacobian = [&](const VectorXd& x) -> MatrixXd {
      MatrixXd J = MatrixXd::Zero(rows + 1, rows + 1);
      J.topLeftCorner(rows, rows) = root_problem(equations_, x[rows], unit).jacobian(x.head(rows));
      J.col(rows).head(rows) = -equations_.system.q / unit;
      const VectorXd c = x(own);
      J.row(rows)(own) = n_directions == 1 ? VectorXd::Ones(1) : VectorXd(c / c.norm());
      return J;
    };
    const double from = position(a.c), to = position(b.c);
    const double share = from == to ? 0.5 : std::clamp((mark - from) / (to - from), 0.0, 1.0);
    VectorXd c = (1 - share) * a.c + share * b.c;
    if (!(c(own).norm() > 0)) return std::nullopt;
    constexpr double tolerance = 1e-13, enough = 1e-11;
    constexpr int most_iterations = 60;
    double load = (1 - share) * a.load + share * b.load;
    int iterations = 0;
    for (const bool again : {false, true}) {  // relative to the full load, then if need be to its own
      unit = force_scale(equations_.system, again ? load : 1);
      VectorXd start(rows + 1);
      start << c / unit, load;
      const Root root = newton_root(problem, start, {again ? enough : tolerance, most_iterations});
      if (!(root.residual.lpNorm<Eigen::Infinity>() <= enough)) {
        if (again) break;
        return std::nullopt;
      }
      c = unit * root.x.head(rows);
      load = root.x[rows];
      iterations += root.iterations;
    }
    // Exactly on it: then nothing bears yet.
    if (n_directions == 1) {
      c[plane] = mark;
    } else {
      c(own) *= mark / position(c);
    }
    return Crossing{load, std::move(c), iterations};
  }

  /// The first crossing of those that the stages tell of, if nothing else has happened before.
  [[nodiscard]] std::optional<Crossing> first_crossing(const Sample& a, const Sample& b) const {
    std::vector<Crossing> all;
    for (Index j = 0; j < a.stages.size(); ++j) {
      if (a.stages[j] == b.stages[j]) continue;
      const double mark = next_mark(j, a.stages[j], b.stages[j]);
      const auto found = crossing(a, b, j, mark);
      const double at_start = is_on_mark(a.c, j, mark) ? together : -together;
      if (!found || found->load < a.load + at_start || found->load > b.load + together) return std::nullopt;
      all.push_back(*found);
    }
    const auto first =
        std::min_element(all.begin(), all.end(), [](const Crossing& x, const Crossing& y) { return x.load < y.load; });
    if (first == all.end() || contact_state(equations_.contacts, first->c).spent) return std::nullopt;
    const VectorXi here = marks_.stages(first->c);
    for (Index j = 0; j < here.size(); ++j) {
      if (here[j] == a.stages[j] ||
          (a.stages[j] != b.stages[j] && is_on_mark(first->c, j, next_mark(j, a.stages[j], b.stages[j]))))
        continue;
      return std::nullopt;
    }
    return *first;
  }

  [[nodiscard]] bool is_on_mark(const VectorXd& c, Index plane, double mark) const {
    const double x = amounts(c, equations_.n_directions())[plane];
    return std::abs(x - mark) <= marks_.nearness(c, std::abs(mark));
  }

  /// Stages behind a crossing: all planes that are on the mark they pass have passed it.
  [[nodiscard]] VectorXi stages_behind(const Sample& a, const Sample& b, const VectorXd& c) const {
    VectorXi stages = a.stages;
    for (Index j = 0; j < stages.size(); ++j) {
      if (stages[j] == b.stages[j] || !is_on_mark(c, j, next_mark(j, stages[j], b.stages[j]))) continue;
      stages[j] += b.stages[j] > stages[j] ? 1 : -1;
    }
    return stages;
  }

  /// dc / d load factor.
  [[nodiscard]] VectorXd rate(const Sample& at) const {
    const double unit = force_scale(equations_.system, at.load);
    const MatrixXd J = root_problem(equations_, at.load, unit).jacobian(at.c / unit);
    return J.partialPivLu().solve(equations_.system.q);
  }

  /// Whether the cubics through positions and rates at both ends pass marks that both ends are on the same side of.
  [[nodiscard]] bool points_beyond_a_mark(const Sample& a, const Sample& b) const {
    const double length = b.load - a.load;
    const VectorXd rate_a = length * rate(a), rate_b = length * rate(b);
    if (!rate_a.allFinite() || !rate_b.allFinite()) return false;
    for (const double t : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      const double s = 1 - t;
      const VectorXd c = s * s * (1 + 2 * t) * a.c + t * t * (1 + 2 * s) * b.c + s * t * (s * rate_a - t * rate_b);
      const VectorXi stages = marks_.stages(c);
      for (Index j = 0; j < stages.size(); ++j)
        if (stages[j] != a.stages[j] && !is_on_a_mark(a.c, j) && !is_on_a_mark(b.c, j)) return true;
    }
    return false;
  }

  /// There the rate is that of one side only.
  [[nodiscard]] bool is_on_a_mark(const VectorXd& c, Index plane) const {
    const auto& marks = marks_.of(plane);
    return std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) {
      return is_on_mark(c, plane, mark.at) || is_on_mark(c, plane, -mark.at);
    });
  }

  const JointEquations& equations_;
  const ContactMarks& marks_;
  Walk& walk_;
  FoundEvents found_;
};

/// Events that are one at a time within rounding become one.
void join_events(std::vector<EventPlace>& events) {
  std::vector<EventPlace> joined;
  for (auto& event : events) {
    if (joined.empty() || event.place.load_factor - joined.back().place.load_factor > together) {
      joined.push_back(std::move(event));
    } else {
      auto& before = joined.back().events;
      before.insert(before.end(), event.events.begin(), event.events.end());
    }
  }
  events = std::move(joined);
}

}  // namespace

FoundEvents search_events(const JointEquations& equations, const ContactMarks& marks, Walk& walk) {
  FoundEvents found = Search(equations, marks, walk).run();
  join_events(found.events);
  return found;
}

}  // namespace fastjoint::stage3
