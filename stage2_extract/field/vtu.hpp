// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage2_extract/field/field.hpp"
#include "stage2_extract/field/field_state.hpp"

namespace fastjoint::stage2 {

/// The field as an unstructured grid of VTK (XML, ASCII) of Lagrange quadrilaterals.
///
/// Points: displacement, stress_xx, stress_yy, stress_xy, von_mises, principal_1, principal_2. Cells: thickness. Of the
/// whole: names of plate, state and units, the holes, and of a joint's state its sheet and increment.
/// VTK File Formats, Kitware, section "XML File Formats", UnstructuredGrid.
[[nodiscard]] std::string vtu(const formats::PlateSolution& plate, const FieldState& state, const Field& field);

}  // namespace fastjoint::stage2
