// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "tests/support/plates.hpp"

namespace fastjoint::test {

/// A name and the text of a PLATE.json.
struct PlateText {
  const char* name;
  std::string json;
};

/// Plates of every kind that a factor meets: spaces, rings, thicknesses, supports, externals, points, links, own mesh,
/// contact beside springs and an open hole.
[[nodiscard]] std::vector<PlateText> plate_scenes();

}  // namespace fastjoint::test
