// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint {

/// Labels of the user's consistent set of units; empty if the file has none.
struct Units {
  std::string length;
  std::string force;
  friend bool operator==(const Units&, const Units&) = default;
};

/// Label of length^l force^f: "in^2", "lbf/in^0.7", "1" if dimensionless. All unit attributes of files are made by it.
[[nodiscard]] std::string unit(const Units& units, double length_power, double force_power);

}  // namespace fastjoint
