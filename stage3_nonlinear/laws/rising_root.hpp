// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fastjoint::stage3 {

/// Root of a rising function of one variable between low and high, where it is <= 0 and >= 0: Newton's method within
/// bounds that close in, bisection where it leaves them.
///
/// @param at x -> {value, derivative}
template <class Function>
[[nodiscard]] double rising_root(Function at, double low, double high) {
  constexpr int most = 200;
  double x = high;
  for (int i = 0; i < most && low < high; ++i) {
    const auto [value, derivative] = at(x);
    (value > 0 ? high : low) = x;
    double next = x - value / derivative;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || next == low || next == high) break;
    x = next;
  }
  return x;
}

}  // namespace fastjoint::stage3
