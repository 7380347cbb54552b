// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "common/input/value.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Reads "loads" of a scene whose holes, points and externals are known: all externals at force 0 and all discs at
/// displacement 0 but for those listed. They must be there if and only if some springs push but do not pull.
[[nodiscard]] std::optional<SceneLoads> read_loads(const input::Value& root, const PlateScene& scene);

}  // namespace fastjoint::stage1
