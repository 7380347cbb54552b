// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/stress_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/infinite.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

/// Share by which stresses differ that are equal but for rounding: the first of them counts.
constexpr double same = 1e-9;

/// Puts later numbers in place of those that they exceed, and where they are not known.
void take(const Eigen::ArrayXXd& later, const Eigen::ArrayXXi& at, double sign, Eigen::ArrayXXd& most,
          Eigen::ArrayXXi& most_at) {
  const auto exceeds = (sign * (later - most) > same * most.abs() || later.isNaN()).eval();
  most = exceeds.select(later, most);
  most_at = exceeds.select(at, most_at);
}

/// The first spot of the largest range of a hole; -1 without one.
Index widest_spot(const Eigen::ArrayXd& range) {
  double most = -infinite;
  Index spot = -1;
  for (Index i = 0; i < range.size(); ++i)
    if (range[i] > most + same * std::abs(most) || (spot < 0 && std::isfinite(range[i]))) most = range[i], spot = i;
  return spot;
}

}  // namespace

void append(std::vector<SpotExtremes>& all, std::vector<SpotExtremes> later, Index n_before) {
  for (auto& each : later) each.largest_at += int(n_before), each.smallest_at += int(n_before);
  if (all.empty()) return all.swap(later);
  for (std::size_t i = 0; i < later.size(); ++i) {
    take(later[i].largest, later[i].largest_at, 1, all[i].largest, all[i].largest_at);
    take(later[i].smallest, later[i].smallest_at, -1, all[i].smallest, all[i].smallest_at);
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
      const formats::PlateHistory& plate = result.plates[i];
      const auto error = [&](int row) { return plate.columns["rim/peak_error"](row, hole); };
      formats::StressRange range;
      range.of = plate.name + ":" + plate.holes.hole[hole];
      range.angle = std::remainder(360.0 * double(spot) / double(its.largest.rows()), 360);
      range.largest = its.largest(spot, hole), range.smallest = its.smallest(spot, hole);
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
