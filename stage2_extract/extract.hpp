// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"
#include "common/matrices/stiffness_error.hpp"
#include "stage2_extract/matrices/checks.hpp"
#include "stage2_extract/stresses/fields.hpp"

namespace fastjoint::stage2 {

/// Everything linear about the plate, for every p, and how well it satisfies what must hold.
struct Extraction {
  formats::PlateMatrices matrices;
  std::vector<matrices::RelativeError> errors;  ///< estimated, at the highest p; infinite with one degree
  Checks checks;
};

/// @param generator Name and version of the program.
/// @param solver    Solver of the plate, if stresses at rims and forces over sections are wanted in every unit case,
/// else null.
[[nodiscard]] Extraction extract(const formats::PlateSolution& plate, const std::string& generator,
                                 FieldSolver* solver);

}  // namespace fastjoint::stage2
