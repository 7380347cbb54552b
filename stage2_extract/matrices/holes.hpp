// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Describes the holes of the plate and the sheet there; with stresses also the sections, and the waves and section
/// forces in every unit case at the highest degrees, as solved by stage 1.
[[nodiscard]] formats::PlateStresses describe_holes(const formats::PlateSolution& plate, bool with_stresses);

}  // namespace fastjoint::stage2
