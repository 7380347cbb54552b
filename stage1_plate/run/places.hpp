// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/header.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Places at which discs, externals and supports act on the plate.
[[nodiscard]] formats::Places places_of(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem);

}  // namespace fastjoint::stage1
