// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"

namespace fastjoint::stage3 {

/// Discs of a sheet whose centres have one coordinate along the axis in which they move.
struct DiscRow {
  int axis;                  ///< 0 x, 1 y
  double at;                 ///< mean coordinate of their centres, length
  std::vector<Index> discs;  ///< unknowns along the axis
};

/// The rows of a sheet, of each axis of the joint in ascending order; none if its file does not tell the places.
/// Centres that differ by less than a thousandth of the extent of all are of one row.
[[nodiscard]] std::vector<DiscRow> disc_rows(const PlateModel& plate);

[[nodiscard]] formats::RowList row_list(const std::vector<DiscRow>& rows);

/// Forces along the axis of each row, (rows, 3): of the fasteners on the sheet, positive along + axis, and of the sheet
/// over its section just before and just after the row, tension positive; infinite where the section crosses an edge on
/// which forces act along the axis.
[[nodiscard]] MatrixXd row_forces(const PlateModel& plate, const std::vector<DiscRow>& rows, const PlateState& state);

[[nodiscard]] PlateGroup row_quantities(std::vector<DiscRow> rows);

}  // namespace fastjoint::stage3
