// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/disc_rows.hpp"

#include <algorithm>
#include <limits>

namespace fastjoint::stage3 {

double row_tolerance(const PlateModel& plate, int axis) {
  constexpr double relative = 1e-3;
  const auto centers = plate.places.disc.col(axis);
  return centers.size() == 0 ? 0 : relative * (centers.maxCoeff() - centers.minCoeff());
}

std::vector<DiscRow> disc_rows(const PlateModel& plate) {
  std::vector<DiscRow> rows;
  if (!plate.places.is_known()) return rows;
  for (const int axis : plate.axes) {
    std::vector<Index> order;
    for (Index i = 0; i < std::ssize(plate.discs); ++i)
      if (plate.axis_of(plate.discs[i]) == axis) order.push_back(i);
    const auto at = [&](Index disc) { return plate.places.disc(disc, axis); };
    std::ranges::stable_sort(order, {}, at);
    double first = -std::numeric_limits<double>::infinity();
    for (const Index i : order) {
      if (at(i) - first > row_tolerance(plate, axis)) rows.push_back({axis, 0, {}}), first = at(i);
      DiscRow& row = rows.back();
      row.at += (at(i) - row.at) / double(row.discs.size() + 1);
      row.discs.push_back(plate.discs[i]);
    }
  }
  return rows;
}

}  // namespace fastjoint::stage3
