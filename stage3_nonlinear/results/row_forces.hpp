// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/model/disc_rows.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

[[nodiscard]] formats::RowList row_list(const std::vector<DiscRow>& rows);

/// Forces along the axis of each row, (rows, 3): of the fasteners on the sheet, positive along + axis, and of the sheet
/// over its section just before and just after the row, tension positive; infinite where the section crosses an edge on
/// which forces act along the axis.
[[nodiscard]] MatrixXd row_forces(const PlateModel& plate, const std::vector<DiscRow>& rows, const PlateState& state);

/// Tension over the whole section of a sheet across an axis at each of some coordinates, force; infinite as above.
[[nodiscard]] VectorXd tensions(const PlateModel& plate, int axis, const PlateState& state, const VectorXd& at);

[[nodiscard]] PlateGroup row_quantities(std::vector<DiscRow> rows);

}  // namespace fastjoint::stage3
