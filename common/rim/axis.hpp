// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <compare>
#include <string>
#include <vector>

#include "common/rim/angles.hpp"

namespace fastjoint::rim {

/// Coordinate axis of the plane, along which discs, supports and externals have their directions.
enum class Axis { x, y };
inline constexpr std::array both_axes = {Axis::x, Axis::y};

/// Names of the axes in inputs and files, in the order of the enumeration.
inline const std::vector<std::string> axis_names = {"x", "y"};

/// Index of the coordinate along an axis, 0 or 1.
[[nodiscard]] constexpr int coordinate(Axis axis) { return static_cast<int>(axis); }
[[nodiscard]] constexpr Axis other(Axis axis) { return axis == Axis::x ? Axis::y : Axis::x; }
[[nodiscard]] inline const std::string& name_of(Axis axis) { return axis_names[coordinate(axis)]; }

/// @param name One of axis_names.
[[nodiscard]] inline Axis axis_named(const std::string& name) {
  return static_cast<Axis>(std::find(axis_names.begin(), axis_names.end(), name) - axis_names.begin());
}
[[nodiscard]] inline Eigen::Vector2d unit_vector(Axis axis) { return Eigen::Vector2d::Unit(coordinate(axis)); }

/// Direction along (sign +1) or against (-1) an axis, which also denotes the side of a hole there.
struct SignedAxis {
  Axis axis;
  int sign;
  friend auto operator<=>(const SignedAxis&, const SignedAxis&) = default;
};

/// Name of a signed axis in inputs and files: "+x", "-x", "+y" or "-y".
[[nodiscard]] inline std::string name_of(const SignedAxis& side) {
  return std::string(1, side.sign > 0 ? '+' : '-') + name_of(side.axis);
}
[[nodiscard]] inline SignedAxis signed_axis_named(const std::string& name) {
  return {axis_named(name.substr(1)), name[0] == '+' ? 1 : -1};
}
/// Angle of its direction from x, radians.
[[nodiscard]] inline double angle_of(const SignedAxis& side) {
  return (side.axis == Axis::x ? 0 : full_turn / 4) + (side.sign > 0 ? 0 : full_turn / 2);
}
[[nodiscard]] inline Eigen::Vector2d unit_vector(const SignedAxis& side) { return side.sign * unit_vector(side.axis); }

}  // namespace fastjoint::rim
