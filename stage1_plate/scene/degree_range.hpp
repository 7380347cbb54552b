// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Replaces the scene's degrees by the option's: "8" is that degree alone, "4..8" a range, "" leaves the scene's.
/// Throws InputError for anything else or outside 1..8.
void set_degrees(PlateScene& scene, const std::string& option);

/// Those that the scene is solved at, ascending.
[[nodiscard]] Eigen::VectorXi degrees(const PlateScene& scene);

}  // namespace fastjoint::stage1
