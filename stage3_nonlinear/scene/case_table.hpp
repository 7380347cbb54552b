// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Reads load cases from a table: a case in each row, named in the column "case", and in each other column the load of
/// one external, "plate:external", a force unless " displacement" or " moment" follows; an empty cell is 0.
///
/// @param load_factors Of the increments of every case.
/// Throws FileError or InputError with the line and the column.
[[nodiscard]] std::vector<CaseScene> read_case_table(const std::string& path, const std::vector<PlateScene>& plates,
                                                     const std::vector<double>& load_factors);

}  // namespace fastjoint::stage3
