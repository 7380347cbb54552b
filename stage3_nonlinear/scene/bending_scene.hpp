// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// How the end of a sheet is held against bending: not at all, w = 0, w = w' = 0, or w' = 0 alone.
enum class EndHold { free, hinged, clamped, symmetric };

/// Heads of fasteners: those that let neighbouring sheets have slopes of their own, and those that make them equal.
enum Heads : int { free_heads, clamped_heads };

struct PlateScene;

/// "bending" of JOINT.json: how secondary bending is modelled.
struct BendingScene {
  bool is_wanted = true;
  std::vector<Heads> heads{free_heads, clamped_heads};  ///< those computed
  bool way_back = true;                                 ///< slopes and shortening act back on the forces in the plane
  double mismatch = 0.01;  ///< largest change of the moments by the last solution, relative to the largest
  /// Ends of each plate that it names, at the least and the greatest x, then y; those not given are hinged where they
  /// are loaded or supported, else free.
  std::map<std::string, std::array<std::optional<EndHold>, 4>> ends{};
};

/// Reads "bending". @param plates Those of the joint.
[[nodiscard]] BendingScene read_bending(const input::Value& value, const std::vector<PlateScene>& plates);

}  // namespace fastjoint::stage3
