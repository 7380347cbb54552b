// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <variant>

#include "common/input/value.hpp"
#include "stage1_plate/read_material.hpp"
#include "stage1_plate/scene.hpp"

namespace fastjoint::stage1 {

[[nodiscard]] Eigen::Vector2d read_point(const input::Value& value);

/// Reads "geometry": {"grid": ...} or {"mesh": ...}.
[[nodiscard]] std::variant<GridGeometry, MeshGeometry> read_geometry(const input::Value& value,
                                                                     const Materials& materials);

}  // namespace fastjoint::stage1
