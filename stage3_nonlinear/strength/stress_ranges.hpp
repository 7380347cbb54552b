// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/formats/joint_result.hpp"

namespace fastjoint::stage3 {

/// Largest and smallest hoop stress at each spot of the rims of a plate over increments. The spots of a hole stand in
/// equal steps around its whole circle, the first at 0 degrees.
struct SpotExtremes {
  Eigen::ArrayXXd largest, smallest;        ///< (spots, holes) stress; NaN where not known at any increment
  Eigen::ArrayXXi largest_at, smallest_at;  ///< (spots, holes) increments where they are, from 0
  int n_increments = 1;

  /// Extremes of one increment alone. @param hoop (spots, holes) stress; NaN where not known.
  explicit SpotExtremes(const Eigen::MatrixXd& hoop)
      : largest(hoop),
        smallest(hoop),
        largest_at(Eigen::ArrayXXi::Zero(hoop.rows(), hoop.cols())),
        smallest_at(largest_at) {}
};

/// Takes in later increments of the same plates.
void append(std::vector<SpotExtremes>& all, std::vector<SpotExtremes> later);

/// Finds the spot of each hole whose stress varies most over all increments at which it is known, the largest range
/// first. Holes whose stress does not vary, or is known at no spot, have none, and neither has a single increment.
/// @param plates As those of the result, whose errors of the peaks give that of a range.
[[nodiscard]] std::vector<formats::StressRange> stress_ranges(const std::vector<SpotExtremes>& plates,
                                                              const formats::JointResult& result);

}  // namespace fastjoint::stage3
