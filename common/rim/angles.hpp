// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fastjoint::rim {

inline constexpr double full_turn = 2 * std::numbers::pi;
inline constexpr double degree = full_turn / 360;  ///< radians

/// The equal angle, up to full turns, in [low, low + 2 pi), radians.
[[nodiscard]] inline double wrapped(double angle, double low) {
  return angle - full_turn * std::floor((angle - low) / full_turn);
}

/// The equal angle, up to full turns, in [-pi, pi), radians.
[[nodiscard]] inline double wrapped(double angle) {
  const double result = wrapped(angle, -full_turn / 2);
  return result < full_turn / 2 ? result : -full_turn / 2;  // rounding can lift it to pi
}

/// Part of a rim, radians counter-clockwise from x: from < to <= from + 2 pi.
struct AngleRange {
  double from, to;
  friend bool operator==(const AngleRange&, const AngleRange&) = default;
};

/// True if one of the ranges contains the angle or an equal angle up to full turns.
[[nodiscard]] inline bool covers(const std::vector<AngleRange>& ranges, double angle) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const AngleRange& range) { return wrapped(angle, range.from) <= range.to; });
}

}  // namespace fastjoint::rim
