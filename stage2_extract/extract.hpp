// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"
#include "common/matrices/stiffness_error.hpp"
#include "stage2_extract/matrices/checks.hpp"

namespace fastjoint::stage2 {

/// Everything linear about the plate, for every p, and how well it satisfies what must hold.
struct Extraction {
  formats::PlateMatrices matrices;
  std::vector<matrices::RelativeError> errors;  ///< estimated, at the highest p; infinite with one degree
  Checks checks;
};

/// @param file      Name of the plate's file, for messages.
/// @param generator Name and version of the program.
[[nodiscard]] Extraction extract(const formats::PlateSolution& plate, const std::string& file,
                                 const std::string& generator);

}  // namespace fastjoint::stage2
