// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "stage3_nonlinear/results/loaded_rims.hpp"

namespace fastjoint::stage3 {

/// Largest hoop stress around a hole.
struct HoopPeak {
  double value, angle, error;  ///< stress, degrees above -180 up to 180, stress (infinite of one degree or one wave)
  /// Hoop stress at the points of TractionWaves, at the one next to the peak that of the peak; NaN beyond the modelled
  /// part and where excluded.
  VectorXd at_points;
};

/// Finds the largest hoop stress on the modelled part of a rim, or on the concentric circle at a distance from it, with
/// its estimated error (docs/theory.md, sections 11.4 and 11.8).
///
/// @param jumps    Angles at which friction jumps, degrees; points within 7.5 degrees of them are excluded. None of the
///                 circle at a distance, where stresses are smooth.
/// @param distance From the rim into the sheet, length.
/// @return Nothing if all points are excluded.
[[nodiscard]] std::optional<HoopPeak> hoop_peak(const LoadedRim& rim, const std::vector<double>& jumps,
                                                double distance = 0);

}  // namespace fastjoint::stage3
