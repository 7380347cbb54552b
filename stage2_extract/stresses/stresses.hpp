// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "stage2_extract/stresses/fields.hpp"

namespace fastjoint::stage2 {

/// Stresses at the rims and forces over the sections beside the holes in every unit case, at the two highest degrees.
/// @param solver Of the plate; null for what is known without solving alone.
[[nodiscard]] formats::PlateStresses extract_stresses(const formats::PlateSolution& plate, FieldSolver* solver);

/// Bytes of the stresses at the rims, which are by far the most of them, and of the fields that they are taken from.
[[nodiscard]] double stress_bytes(const formats::PlateSolution& plate);

}  // namespace fastjoint::stage2
