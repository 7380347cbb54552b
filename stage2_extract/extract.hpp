// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"
#include "common/matrices/stiffness_error.hpp"
#include "stage2_extract/matrices/checks.hpp"

namespace fastjoint::stage2 {

/// The condensed linear model of the plate for every p, its estimated errors and checks.
struct Extraction {
  formats::PlateMatrices matrices;
  std::vector<matrices::RelativeError> errors;  ///< estimated at the highest p; infinite for a single degree
  Checks checks;
};

/// @param generator Name and version of the program.
/// @param with_stresses Includes the data for stresses at rims and forces over sections.
[[nodiscard]] Extraction extract(formats::PlateSolution plate, const std::string& generator, bool with_stresses);

}  // namespace fastjoint::stage2
