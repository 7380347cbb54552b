// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/input/value.hpp"
#include "stage1_plate/scene/scene.hpp"

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

[[nodiscard]] Eigen::Vector2d read_point(const input::Value& value);

/// Reads a list of edges, each by its two nodes, and at least one.
[[nodiscard]] std::vector<std::pair<int, int>> read_edges(const input::Value& value, int n_nodes);

/// Reads "geometry": {"grid": ...} or {"mesh": ...} without its "sections", which need the holes.
[[nodiscard]] std::variant<GridGeometry, MeshGeometry> read_geometry(const input::Value& value,
                                                                     const Materials& materials);

/// Reads "sections" of an explicit mesh into the scene's geometry; needs its holes and the directions of its discs.
void read_sections(const input::Value& root, PlateScene& scene);

/// Reads "spring" of a hole of that radius: what its stiffness follows from, where on the rim it acts, and how.
[[nodiscard]] Spring read_spring(const input::Value& value, double radius);

/// Reads "loads" of a scene whose holes, points and externals are known: all externals at force 0 and all discs at
/// displacement 0 but for those listed. They must be there if and only if some springs push but do not pull.
[[nodiscard]] std::optional<SceneLoads> read_loads(const input::Value& root, const PlateScene& scene);

}  // namespace fastjoint::stage1
