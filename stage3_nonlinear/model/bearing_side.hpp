// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/rim/axis.hpp"

namespace fastjoint::stage3 {

/// Side of a hole that bears; none of an edge.
using BearingSide = std::optional<rim::SignedAxis>;

/// Sides by their names in files; none for other texts, such as "" for edges.
[[nodiscard]] std::vector<BearingSide> bearing_sides(const std::vector<std::string>& names);

/// Names of sides, "" for none.
[[nodiscard]] std::vector<std::string> names_of(const std::vector<BearingSide>& sides);

}  // namespace fastjoint::stage3
