// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

using LawPointer = std::shared_ptr<const Law>;

/// Spring of stiffness k > 0, force / length.
[[nodiscard]] LawPointer linear_law(double k, std::optional<Source> source);

/// Points (delta, F) of a fastener's test; length and force, neither negative.
using TestPoints = std::vector<std::array<double, 2>>;

/// Reads points in the order of the file.
///
/// A text file of two columns, parted by commas, semicolons or tabs, with decimal points; a first line of two names is
/// passed over, and so are empty lines and what follows a '#'. Throws InputError with file, line, what was found and
/// what is allowed; FileError if the file cannot be read.
[[nodiscard]] TestPoints read_points(const std::string& path);

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
