// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage1 {

/// Materials in the order of their names.
struct Materials {
  std::vector<std::string> name;
  std::vector<Eigen::Matrix3d> elasticity;  ///< for the scene's analysis, stress
};

/// Open interval of Poisson's ratio of an isotropic body.
inline constexpr input::Range poisson_range{.low = -1, .high = 0.5, .low_allowed = false, .high_allowed = true};

/// Reads "analysis" and "materials" of a scene.
[[nodiscard]] Materials read_materials(const input::Value& root);

}  // namespace fastjoint::stage1
