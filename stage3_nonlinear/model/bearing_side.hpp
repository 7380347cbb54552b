// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/rim/angles.hpp"

namespace fastjoint::stage3 {

/// Names of the axes.
inline constexpr std::array axis_names{"x", "y"};

/// Side of a hole: the half of its rim around the direction + or - an axis.
struct BearingSide {
  int axis = 0;  ///< 0 x, 1 y
  int sign = 1;  ///< 1 or -1

  bool operator==(const BearingSide&) const = default;
  /// Angle of its direction, radians.
  [[nodiscard]] double direction() const {
    return (axis == 0 ? 0 : rim::full_turn / 4) + (sign > 0 ? 0 : rim::full_turn / 2);
  }
  /// Its name in files, "+x", "-x", "+y" or "-y".
  [[nodiscard]] std::string name() const { return (sign > 0 ? "+" : "-") + std::string(axis_names[axis]); }
};

/// The side with a name; none for other texts, such as "" for edges.
[[nodiscard]] inline std::optional<BearingSide> bearing_side(const std::string& name) {
  for (const int axis : {0, 1})
    for (const int sign : {1, -1})
      if (const BearingSide side{axis, sign}; side.name() == name) return side;
  return std::nullopt;
}

/// Names of sides, "" for none.
[[nodiscard]] inline std::vector<std::string> names_of(const std::vector<std::optional<BearingSide>>& sides) {
  std::vector<std::string> names;
  for (const auto& side : sides) names.push_back(side ? side->name() : "");
  return names;
}

}  // namespace fastjoint::stage3
