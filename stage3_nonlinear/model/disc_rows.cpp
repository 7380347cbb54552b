// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/disc_rows.hpp"

#include <algorithm>
#include <limits>

namespace fastjoint::stage3 {

double row_tolerance(const PlateModel& plate, int axis) {
  constexpr double of_extent = 1e-3, of_radius = 0.1, rounding = 1e-9;
  const auto& centers = plate.places.disc;
  if (centers.rows() == 0) return 0;
  const Eigen::RowVector2d extent = centers.colwise().maxCoeff() - centers.colwise().minCoeff();
  const auto& radii = plate.stresses.rim_radius;
  return std::max(
      {of_extent * extent[axis], radii.size() > 0 ? of_radius * radii.minCoeff() : 0,
       rounding * (extent.maxCoeff() + centers.cwiseAbs().maxCoeff() + plate.places.external.cwiseAbs().sum())});
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
