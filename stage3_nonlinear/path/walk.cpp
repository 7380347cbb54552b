// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <utility>

#include "stage3_nonlinear/equations/first_guesses.hpp"

namespace fastjoint::stage3 {
double force_scale(const JointEquations& equations, double load_factor) {
  constexpr double of_gaps = 1e-4;  // rounding of their displacements and of sets is far below the tolerance times this
  const double load = equations.rigid_forces(load_factor).lpNorm<Eigen::Infinity>();
  const double scale = std::max({load, of_gaps * std::max(equations.force_of_gaps(), equations.force_of_sets()),
                                 load == 0 ? equations.force_of_gaps(true) : 0});
  return scale > 0 ? scale : 1;
}

Walk::Walk(const JointEquations& equations, const PathOptions& options)
    : equations_(equations),
      options_(options),
      solver_(iterative_method(options.solver.method, equations.n_unknowns()) == Method::damped_newton ? newton_root
                                                                                                       : hybridsj_root),
      may_snap_(!planes_that_may_snap(equations).empty()),
      here_{0, options.start.value_or(VectorXd::Zero(equations.n_unknowns()))} {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  rounding_ =
      rounding * std::max({equations.force_of_clearances(), equations.force_of_gaps(), equations.force_of_offsets()});
}

bool Walk::reach(double target) {
  guessed_.clear();
  constexpr Index quick = 400;  // up to this number of rows the bound takes less time than a try
  iterations_ = 0;
  if (equations_.n_unknowns() == 0) {  // sheets without fasteners and contact: the loads say all
    here_.load_factor = target;
    return true;
  }
  if (equations_.n_plane_rows() <= quick) (void)limit(target);
  if (is_known_beyond_limit(target)) {  // only the largest load factor that converges remains to be found
    constexpr double just_below = 1 - 1e-9;
    if (solve_from_here(std::copysign(just_below * limit(target)->factor, target))) return false;
  }
  const Place before = here_;
  const bool started = may_snap_ || here_.load_factor != 0 || !equations_.starts_unloaded();
  if (started && follow(target, max_halvings)) return true;
  const Place furthest = std::exchange(here_, before);
  if (!guess(target, max_halvings)) {
    if (std::abs(target - furthest.load_factor) < std::abs(target - here_.load_factor)) here_ = furthest;
    return false;
  }
  if (may_snap_ && !left_) left_ = {target, true};
  return true;
}

bool Walk::jump(const Place& from) {
  iterations_ = 0;
  here_ = from;
  return equations_.n_unknowns() == 0 || solve_from_here(from.load_factor);
}

PathStep Walk::step(const Place& at, const ContactState& state, const TangentCheck& check) const {
  const VectorXd r = equations_.residual(state, at.load_factor);
  const Index planes = equations_.n_plane_rows(), rims = state.F.size() - planes;
  const double scale = std::max(force_scale(equations_, at.load_factor), rounding_ / options_.solver.tolerance);
  return {.load_factor = at.load_factor,
          .F = state.F.head(planes),
          .delta = state.delta.head(planes),
          .iterations = iterations_,
          .residual = r.lpNorm<Eigen::Infinity>() / scale,
          .check = check,
          .rim_F = state.F.tail(rims),
          .moments = state.delta.tail(rims),
          .Lambda = state.Lambda,
          .c = at.c,
          .scale = scale};
}

namespace {

bool moves(const VectorXd& motion) { return motion.size() > 0 && !motion.isZero(0); }

/// Adds the events of planes that remember: where they begin to slip or yield, or do so the other way, unless that is
/// said of this increment or of the one before, and where they cease to.
void add_events(const std::vector<PlaneMemory>& before, const std::vector<PlaneMemory>& now, const LoadPath& path,
                std::vector<ContactEvent>& events) {
  const auto is_said = [](const std::vector<ContactEvent>& in, const ContactEvent& event) {
    return std::ranges::find(in, event) != in.end();
  };
  for (Index j = 0; j < std::ssize(now); ++j)
    for (const auto& [motion, kind] :
         {std::pair(&PlaneMemory::slip, CornerKind::slip), std::pair(&PlaneMemory::yield, CornerKind::yield)}) {
      const VectorXd &was = before[j].*motion, &is = now[j].*motion;
      const bool turns = moves(was) && moves(is) && was.dot(is) < 0;
      const ContactEvent event{j, kind, !moves(is)};
      if ((moves(is) == moves(was) && !turns) || is_said(events, event)) continue;
      if (event.back || turns || path.steps.empty() || !is_said(path.steps.back().events, event))
        events.push_back(event);
    }
}

}  // namespace

bool Walk::record(LoadPath& path, std::vector<ContactEvent> events) {
  SolvedPoint point(equations_, here_.load_factor, here_.c);
  PathStep step = this->step(point);
  step.events = std::move(events);
  auto unbalanced = options_.each ? options_.each(std::move(point), step) : std::nullopt;
  if (!unbalanced) {
    const auto before = equations_.memories();
    equations_.commit(here_.c);
    path.history = equations_.history;
    step.memories = equations_.memories();
    add_events(before, step.memories, path, step.events);
    path.steps.push_back(std::move(step));
    return true;
  }
  const double reached = path.steps.empty() ? 0 : path.steps.back().load_factor;
  path.failure = PathFailure{std::ssize(path.steps), step.load_factor, reached, 0, 0, {}, {}, std::move(unbalanced)};
  return false;
}

bool Walk::start(LoadPath& path) {
  const bool unloaded = equations_.starts_unloaded();
  if (unloaded && equations_.has_interference() && reach(0)) path.assembled = here_.c;
  if (!equations_.remembers() || (unloaded && equations_.history.empty())) return true;
  if (!reach(0)) {
    path.failure = failure(0, 0);
    return false;
  }
  equations_.commit(here_.c);
  return true;
}

PathFailure Walk::failure(Index increment, double load_factor) {
  PathFailure failure{increment,       load_factor, here_.load_factor,   equations_.entry_of(worst_row_),
                      worst_residual_, {},          locking(load_factor)};
  if (is_known_beyond_limit(load_factor)) {
    failure.level = limit(load_factor)->planes;
    failure.entry = failure.level.front();
    failure.limit = std::copysign(limit(load_factor)->factor, load_factor);
  } else {
    failure.level = level_planes(equations_, best_.size() > 0 ? best_ : here_.c);
    failure.ending = ending_ == Ending::converged ? "past the limit load of a law" : text_of(ending_);
  }
  return failure;
}

std::optional<double> Walk::locking(double load_factor) const {
  const auto last = self_locking(equations_, contact_state(equations_, here_.c).F);
  const auto rigid = self_locking(equations_, equations_.rigid_forces(load_factor));
  return last && rigid ? std::min(*last, *rigid) : last ? last : rigid;
}

/// Goes to a load factor from the last state, in half steps if necessary.
bool Walk::follow(double target, int halvings_left) {
  const Place start = here_;
  const bool whole = !is_known_beyond_limit(target) && solve_from_here(target);
  if (whole && (target == 0 || !may_snap_)) return true;
  const Place there = here_;
  const double middle = 0.5 * (start.load_factor + target);
  if (whole) {
    here_ = start;
    constexpr double same = 1e-3;
    if (solve_from_here(middle) && solve_from_here(target) &&
        (here_.c - there.c).cwiseAbs().maxCoeff() <= same * there.c.cwiseAbs().maxCoeff())
      return true;
  }
  here_ = start;
  if (halvings_left > 0) return follow(middle, halvings_left - 1) && follow(target, halvings_left - 1);
  if (!whole) return false;
  here_ = there;
  if (!left_) left_ = {target, false};
  return true;
}

bool Walk::guess(double target, int halvings_left) {
  if (!is_known_beyond_limit(target) && (begin(target) || solve_from_guesses(target))) return true;
  if (halvings_left == 0) return false;
  const double middle = 0.5 * (here_.load_factor + target);
  if (at_limit() || is_known_beyond_limit(target))  // only the largest load factor that converges remains to be found
    return follow(middle, halvings_left - 1) && follow(target, halvings_left - 1);
  return guess(middle, halvings_left - 1) && guess(target, halvings_left - 1);
}

bool Walk::begin(double target) {
  worst_residual_ = std::numeric_limits<double>::infinity();
  target_ = target;
  scale_ = force_scale(equations_, target);
  const bool remembers = std::ranges::any_of(equations_.history, [](const History& its) { return !its.empty(); });
  if (target != 0 || remembers || equations_.has_interference() || !equations_.starts_unloaded()) return false;
  here_ = {0, VectorXd::Zero(equations_.n_unknowns())};  // the undeformed joint is in exact equilibrium
  return true;
}

bool Walk::solve_from_here(double target) {
  return begin(target) || solve_from({[&] { return predicted(target); }}, target);
}

VectorXd Walk::predicted(double target) const {
  if (may_snap_ || !other_ || other_->load_factor == here_.load_factor) return here_.c;
  const double length = (target - here_.load_factor) / (here_.load_factor - other_->load_factor);
  VectorXd c = here_.c + length * (here_.c - other_->c);
  const auto imbalance = [&](const VectorXd& at) {
    return equations_.residual(contact_state(equations_, at), target).norm();
  };
  return imbalance(c) < imbalance(here_.c) ? c : here_.c;
}

bool Walk::solve_from_guesses(double target) {
  const bool is_new = guessed_.insert(target).second;  // the same guesses would fail as before
  const auto guesses = is_new ? guesses_in_order(options_.initial) : std::vector<InitialScene>();
  std::vector<Start> starts;
  for (const InitialScene& guess : guesses)
    starts.emplace_back([&, guess] { return first_guess(equations_, guess, target); });
  starts.insert(here_.load_factor != 0 || !here_.c.isZero(0) ? starts.begin() : starts.end(), [&] { return here_.c; });
  starts.insert(starts.begin(), [&, first = starts.front()] { return frictionless_start(first, target); });
  for (const InitialScene& guess : guesses)  // starts at large coordinates, for a solution that the others do not reach
    if (may_snap_) starts.emplace_back([&, guess]() -> VectorXd { return 4 * first_guess(equations_, guess, target); });
  return solve_from(starts, target) || (!is_known_beyond_limit(target) && solve_with_lagged_friction(target));
}

std::optional<VectorXd> Walk::frictionless_start(const Start& from, double target) {
  const bool all_gaps = std::ranges::all_of(equations_.rims, [](const auto& rim) { return rim->contact().gap() > 0; });
  if (equations_.rims.empty() || !all_gaps || !equations_.has_friction || !equations_.rises) return std::nullopt;
  const ContactState at_rest = contact_state(equations_, VectorXd::Zero(equations_.n_unknowns()));
  const Root root = run(root_problem(equations_, target, scale_, &at_rest), *from(), newton_root);
  if (!root.converged) return std::nullopt;
  return scale_ * root.x;
}

const std::optional<LimitLoad>& Walk::limit(double target) {
  auto& known = limits_[target < 0 ? 0 : 1];
  if (!known) known = limit_load(equations_, target);
  return *known;
}

bool Walk::is_beyond_limit(double target) {
  constexpr double rounding = 1e-9;
  return limit(target) && std::abs(target) > (1 + rounding) * limit(target)->factor;
}

bool Walk::at_limit() const {
  constexpr double close = 1e-4;  // so close to the limit load another start may reach it
  return !may_snap_ && std::isfinite(worst_residual_) && worst_residual_ > close &&
         !level_planes(equations_, best_).empty();
}

bool Walk::solve_from(const std::vector<Start>& starts, double target) {
  const auto problem = root_problem(equations_, target, scale_);
  const auto solved_by = [&](SolveFunction solver) {
    for (const Start& make_start : starts) {
      const auto start = make_start();
      if (!start) continue;
      const Root root = run(problem, *start, solver);
      if (take(root, target)) return true;
      if (solver != newton_root) continue;
      note_failure(root);  // Newton's method descends, so that its end shows the limit load
      // Without friction it ends there from every start.
      if (is_beyond_limit(target) || (!equations_.has_friction && at_limit())) return false;
    }
    return false;
  };
  return solved_by(solver_) || (solver_ != newton_root && solved_by(newton_root));
}

/// Fixed-point iteration with the friction of the iterate before as a load. Each step has a solution that damped Newton
/// finds, and the iteration converges if friction changes the forces by less than themselves.
bool Walk::solve_with_lagged_friction(double target) {
  constexpr int max_turns = 50;
  if (!equations_.has_friction || !equations_.rises) return false;
  const auto problem = root_problem(equations_, target, scale_);
  VectorXd c = here_.c;
  for (int turn = 0; turn < max_turns; ++turn) {
    const ContactState before = contact_state(equations_, c);
    const Root root = run(root_problem(equations_, target, scale_, &before), c, newton_root);
    if (!root.converged) return false;
    c = scale_ * root.x;
    if (take(run(problem, c, newton_root), target)) return true;
  }
  return false;
}

Root Walk::run(const RootProblem& problem, const VectorXd& start, SolveFunction solver) {
  RootOptions options{options_.solver.tolerance, options_.solver.max_iterations};
  std::optional<Root> before;
  if (options_.log) options.report = [&](const Root& root) { log_iteration(root, before); };
  Root root = solver(problem, start / scale_, options);
  iterations_ += root.iterations;
  ending_ = root.ending;
  if (root.converged && (solver == hybridsj_root || is_far_from_balance(root))) end_by_newton(problem, root);
  if (options_.log) *options_.log << fmt::format("    {}\n", text_of(root.ending));
  return root;
}

bool Walk::is_far_from_balance(const Root& root) const {
  constexpr double close = 1e-9;
  const ContactState state = contact_state(equations_, scale_ * root.x);
  const double largest = state.F.head(equations_.n_plane_rows()).lpNorm<Eigen::Infinity>();
  return scale_ * root.residual.lpNorm<Eigen::Infinity>() > close * largest;
}

void Walk::end_by_newton(const RootProblem& problem, Root& root) {
  Root there = root;
  there.x -= problem.solve(root.x, root.residual);
  if (!there.x.allFinite()) return;
  there.residual = problem.residual(there.x);
  if (there.residual.lpNorm<Eigen::Infinity>() < root.residual.lpNorm<Eigen::Infinity>()) root = std::move(there);
}

void Walk::log_iteration(const Root& root, std::optional<Root>& before) const {
  const double residual = root.residual.lpNorm<Eigen::Infinity>();
  if (!before) {
    *options_.log << fmt::format("  try at load factor {:.9g}: residual {:.1e} of {:.4g}\n", target_, residual, scale_);
  } else {
    const ContactCorners corners(equations_);
    const auto changes =
        (corners.passed(scale_ * root.x).array() != corners.passed(scale_ * before->x).array()).count();
    const VectorXd step = root.x - before->x;
    *options_.log << fmt::format("    {:3}: residual {:.1e}, step {:.1e}, corners passed by {}\n", root.iterations,
                                 residual, step.lpNorm<Eigen::Infinity>(), changes);
  }
  before = root;
}

bool Walk::take(const Root& root, double target) {
  if (!converged(root)) return false;
  VectorXd c = scale_ * root.x;
  const Index planes = equations_.n_plane_rows();
  if (!equations_.rims.empty()) {        // small forces are set to zero if the joint then still balances
    constexpr double max_force = 1e3;    // over the limit of without_rounding
    constexpr double max_residual = 10;  // over that before, or over rounding
    VectorXd rounded = c;
    rounded.head(planes) = without_rounding(c.head(planes), max_force * scale_);
    const auto imbalance = [&](const VectorXd& at) {
      return equations_.residual(contact_state(equations_, at), target).lpNorm<Eigen::Infinity>();
    };
    constexpr double precision = std::numeric_limits<double>::epsilon();
    // Rounding of one wide gap may be far above that of the forces elsewhere, which the sheets amplify.
    constexpr double negligible = 1e-13;
    const double rounding = std::max(std::min(rounding_, negligible * scale_), precision * scale_);
    if (rounded != c && imbalance(rounded) <= max_residual * std::max(imbalance(c), rounding)) c = rounded;
  }
  if (const auto failed = contact_state(equations_, c).failed) {
    if (std::isinf(worst_residual_)) {
      worst_row_ = *failed;
      best_ = c;
    }
    return false;
  }
  if (here_.load_factor != target) other_ = std::move(here_);
  here_ = {target, std::move(c)};
  return true;
}

/// Keeps the try with the smallest residual.
void Walk::note_failure(const Root& root) {
  if (converged(root)) return;  // `take` has refused it as past a limit load
  Index at = 0;
  const double worst = root.residual.cwiseAbs().maxCoeff(&at);
  if (!(worst < worst_residual_)) return;
  worst_residual_ = worst;
  worst_row_ = at;
  best_ = scale_ * root.x;
}

}  // namespace fastjoint::stage3
