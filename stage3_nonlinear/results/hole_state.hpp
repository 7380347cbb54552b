// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "common/formats/plate_matrices.hpp"
#include "stage3_nonlinear/results/loaded_rims.hpp"
#include "stage3_nonlinear/strength/section_state.hpp"

namespace fastjoint::stage3 {

/// One hole of a plate at one increment: its quantities in RESULT.h5, and what the summary and warnings ask of it.
struct HoleState : SectionState {
  double bearing_load = 0, bearing_load_y = 0, bearing_stress = 0;
  double peak_hoop = 0, peak_angle = 0, peak_error = 0;  ///< NaN, NaN and infinite where it is not known
  VectorXd hoop = {};                                    ///< HoopPeak::at_points; none where there is no peak
  double against_slip = 0;                               ///< in contact with friction
  /// The springs are in tension: they are on the side that does not bear.
  bool pulls = false;
  bool filled = false;  ///< springs act all around
  double pull = 0;      ///< largest tension of springs all around; 0 for springs on an arc, stress
  /// Reaction of a disc with one direction along the other axis, where its displacement is fixed: the integral of the
  /// pressure around a whole circle. NaN on a part of a circle, whose disc is fixed by symmetry, and for discs that
  /// move along x and y.
  double across = std::numeric_limits<double>::quiet_NaN();
  double across_ratio = 0;  ///< over the bearing load, or over 1 % of the plate's largest force if that is more
  /// Friction acts along both axes: its stresses are not those of friction along the force.
  bool by_components = false;
};

/// Forces of the fasteners on the m discs of a plate.
struct LoadedDiscs {
  std::vector<std::string> hole;      ///< (m) of each disc
  std::vector<int> axis;              ///< (m) its direction: 0 x, 1 y
  Eigen::VectorXd bearing, friction;  ///< (m) resultants on the rim along it, force
};

/// States of all holes of a plate.
///
/// The error of the peak is that of docs/theory.md, section 11.4 (tests/pipeline/peaks_test.py). Points within 7.5
/// degrees of a jump of friction are excluded from the search for the peak if the jump is more than 1 % of the bearing
/// stress (11.5).
/// @param level    Index in `a` of the joint's degree; the one below, if there is one, gives the errors.
/// @param coefficients  Of the unit cases, (n_cases).
/// @param scale    Reference force of the joint's residuals, for rounding.
/// @param rims     Rims with waves and a closed form; other holes have no peak: NaN with an infinite error.
[[nodiscard]] std::vector<HoleState> hole_states(const formats::PlateStresses& a, const formats::Border& border,
                                                 int level, const VectorXd& coefficients, const LoadedDiscs& discs,
                                                 double scale, const std::vector<std::optional<LoadedRim>>& rims);

/// The holes of a plate, without points.
[[nodiscard]] formats::HoleList holes_of(const formats::PlateStresses& a);

}  // namespace fastjoint::stage3
