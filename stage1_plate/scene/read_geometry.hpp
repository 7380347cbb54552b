// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>
#include <variant>
#include <vector>

#include "common/input/value.hpp"
#include "stage1_plate/scene/read_material.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

[[nodiscard]] Eigen::Vector2d read_point(const input::Value& value);

/// A list of edges, each by its two nodes, and at least one.
[[nodiscard]] std::vector<std::pair<int, int>> read_edges(const input::Value& value, int n_nodes);

/// Reads "geometry": {"grid": ...} or {"mesh": ...} without its "sections", which need the holes: read_sections.hpp.
[[nodiscard]] std::variant<GridGeometry, MeshGeometry> read_geometry(const input::Value& value,
                                                                     const Materials& materials);

}  // namespace fastjoint::stage1
