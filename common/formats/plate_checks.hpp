// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::formats {

/// Rejects a PLATE.h5 with inconsistent datasets: elements, rims, plate unknowns, discs and unit cases are used as
/// indices later, so each must occur once and in the order of stage 1.
///
/// @param file Path of the file. Throws FileError with the dataset, what was found and what was expected.
void check_consistent(const std::string& file, const PlateSolution& plate);

}  // namespace fastjoint::formats
