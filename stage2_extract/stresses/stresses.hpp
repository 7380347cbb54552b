// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Stresses at the rims and forces over the sections beside the holes in every unit case, at the degrees for which the
/// plate has its friction fields; none if it has no such degree.
/// @param file Name of the plate's file, for messages.
[[nodiscard]] formats::PlateStresses extract_stresses(const formats::PlateSolution& plate, const std::string& file);

/// Bytes of the stresses at the rims, which are by far the most of them.
[[nodiscard]] double stress_bytes(const formats::PlateSolution& plate);

}  // namespace fastjoint::stage2
