// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/input/value.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Reads "spring" of a hole of that radius: what its stiffness follows from, where on the rim it acts, and how.
[[nodiscard]] Spring read_spring(const input::Value& value, double radius);

}  // namespace fastjoint::stage1
