// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/plate_model.hpp"

namespace fastjoint::stage3 {

/// Discs of a sheet whose centres have one coordinate along the axis in which they move.
struct DiscRow {
  int axis;                  ///< 0 x, 1 y
  double at;                 ///< mean coordinate of their centres, length
  std::vector<Index> discs;  ///< unknowns along the axis
};

/// The rows of a sheet, of each axis of the joint in ascending order; none if its file does not tell the places.
/// Centres that differ by less than row_tolerance are of one row.
[[nodiscard]] std::vector<DiscRow> disc_rows(const PlateModel& plate);

/// Difference of coordinates along an axis within which two discs are of one row: a thousandth of the extent of all, or
/// a tenth of the smallest radius if that is more; length.
[[nodiscard]] double row_tolerance(const PlateModel& plate, int axis);

}  // namespace fastjoint::stage3
