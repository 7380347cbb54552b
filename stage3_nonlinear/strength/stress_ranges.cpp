// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/stress_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

/// Relative difference of stresses that are equal but for rounding: the first of them counts.
constexpr double same_stress = 1e-9;

/// Updates the largest stresses of all spots, or with a negative sign the smallest, and the increments where they are.
void update(const Eigen::ArrayXXd& later, const Eigen::ArrayXXi& at, double sign, Eigen::ArrayXXd& extreme,
            Eigen::ArrayXXi& extreme_at) {
  const auto exceeds = (sign * (later - extreme) > same_stress * extreme.abs() || extreme.isNaN()).eval();
  extreme = exceeds.select(later, extreme);
  extreme_at = exceeds.select(at, extreme_at);
}

/// The first spot of the largest range of a hole; -1 if none is known.
Index widest_spot(const Eigen::ArrayXd& range) {
  Index spot = -1;
  for (Index i = 0; i < range.size(); ++i)
    if (std::isfinite(range[i]) && (spot < 0 || range[i] > (1 + same_stress) * range[spot])) spot = i;
  return spot;
}

}  // namespace

void append(std::vector<SpotExtremes>& all, std::vector<SpotExtremes> later) {
  if (all.empty()) return all.swap(later);
  for (std::size_t i = 0; i < later.size(); ++i) {
    SpotExtremes& its = all[i];
    update(later[i].largest, later[i].largest_at + its.n_increments, 1, its.largest, its.largest_at);
    update(later[i].smallest, later[i].smallest_at + its.n_increments, -1, its.smallest, its.smallest_at);
    its.n_increments += later[i].n_increments;
  }
}

std::vector<formats::StressRange> stress_ranges(const std::vector<SpotExtremes>& plates,
                                                const formats::JointResult& result) {
  std::vector<formats::StressRange> table;
  if (result.load_factor.size() < 2) return table;
  for (std::size_t i = 0; i < plates.size(); ++i) {
    const SpotExtremes& its = plates[i];
    for (Index hole = 0; hole < its.largest.cols(); ++hole) {
      const Index spot = widest_spot(its.largest.col(hole) - its.smallest.col(hole));
      if (spot < 0) continue;
      const double largest = its.largest(spot, hole), smallest = its.smallest(spot, hole);
      const double nothing = same_stress * std::max(std::abs(largest), std::abs(smallest));
      if (!(largest - smallest > nothing)) continue;
      const formats::PlateHistory& plate = result.plates[i];
      const auto error = [&](int row) { return plate.columns["rim/peak_error"](row, hole); };
      const auto rounded = [&](double stress) { return std::abs(stress) > nothing ? stress : 0; };
      formats::StressRange range;
      range.of = plate.name + ":" + plate.holes.hole[hole];
      range.angle = std::remainder(360.0 * double(spot) / double(its.largest.rows()), 360);
      range.largest = rounded(largest), range.smallest = rounded(smallest);
      range.largest_at = its.largest_at(spot, hole), range.smallest_at = its.smallest_at(spot, hole);
      range.range = range.largest - range.smallest;
      range.error = error(range.largest_at) + error(range.smallest_at);
      table.push_back(range);
    }
  }
  // Equal ones, but for rounding, stay in the order of the joint.
  std::ranges::stable_sort(table, std::ranges::greater(), [](const auto& each) { return float(each.range); });
  return table;
}

}  // namespace fastjoint::stage3
