// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/input/value.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Reads "sections" of an explicit mesh into the scene's geometry; needs its holes and the directions of its discs.
void read_sections(const input::Value& root, PlateScene& scene);

}  // namespace fastjoint::stage1
