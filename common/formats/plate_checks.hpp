// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::formats {

/// Refuses a PLATE.h5 whose datasets, each good by itself, do not fit each other: elements, rims, plate unknowns, discs
/// and unit cases are used as indices later, so each must be there once and in the order that stage 1 gives it.
///
/// @param file Its path. Throws FileError with the dataset, what was found and what was expected.
void check_consistent(const std::string& file, const PlateSolution& plate);

}  // namespace fastjoint::formats
