// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/touch_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "stage3_nonlinear/path/walk.hpp"

namespace fastjoint::stage3 {

VectorXd rate(const JointEquations& equations, const Sample& at) {
  const double unit = force_scale(equations, at.load);
  return root_problem(equations, at.load, unit).solve(at.c / unit, equations.q_at(at.load));
}

bool TouchSearch::make_the_difference(const Sample& a, const Sample& b) const {
  for (Index j = 0; j < std::ssize(a.passed); ++j) {
    const auto& own = corners_.of(j);
    if (a.passed[j] != b.passed[j] && (own.empty() || own.front().kind != CornerKind::touch)) return false;
  }
  return a.passed != b.passed;
}

std::optional<double> TouchSearch::place_between(const Sample& a, const Sample& b) {
  if (!make_the_difference(a, b)) return std::nullopt;
  constexpr double further = 0.02, at_ends = 1e-3, min_reduction = 0.9;
  const double length = b.load - a.load, before = std::exchange(last_length_, length);
  // The rim of a bolt with clearance can touch by rounding, and then gives no estimate.
  if (length < before && length > min_reduction * before) return std::nullopt;
  std::optional<double> first;
  std::array<std::optional<VectorXd>, 2> rates;
  for (Index j = 0; j < std::ssize(a.passed); ++j) {
    if (a.passed[j] == b.passed[j]) continue;
    const bool opens = a.passed[j] > b.passed[j];
    const Sample &closed = opens ? a : b, &open = opens ? b : a;
    auto& there = rates[opens ? 0 : 1];
    if (!there) there = rate(equations_, closed);
    if (!there->allFinite()) return std::nullopt;
    const double depth = corners_.position(closed.c, j) - corners_.of(j).front().at;
    const double by = load_from_touch(j, closed.load, depth / corners_.slope(closed.c, j).dot(*there));
    const double fraction = (1 + further) * -by / (open.load - closed.load);  // of the way to the open state
    if (!(fraction > 0 && fraction < 1 - at_ends)) return std::nullopt;
    const double load = closed.load + std::max(fraction, at_ends) * (open.load - closed.load);
    if (!first || load < *first) first = load;
  }
  return first;
}

double TouchSearch::load_from_touch(Index entry, double load, double ratio) {
  constexpr double usual = 0.9, min_exponent = 0.3, max_exponent = 1.5;
  const auto [place, before] = std::exchange(last_[entry], {load, ratio});
  const double found = (load - place) / (ratio - before);
  const bool known = before != 0 && std::isfinite(found);
  return ratio * (known ? std::clamp(found, min_exponent, max_exponent) : usual);
}

}  // namespace fastjoint::stage3
