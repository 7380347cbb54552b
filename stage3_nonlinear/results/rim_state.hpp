// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "stage3_nonlinear/model/plate_model.hpp"

namespace fastjoint::stage3 {

/// Loads and stresses of one hole of a plate at one increment.
struct RimState {
  double bearing_load = 0;    ///< along x on the plate, force
  double bearing_load_y = 0;  ///< along y, force
  double bearing_stress = 0;  ///< |bearing load| / (d t), stress
  double bypass_load = 0;     ///< force along x that passes the fastener by, tension positive
  double bypass_error = 0;    ///< its change from the degree below; infinite where there is none, force
  double peak_hoop = 0;       ///< largest hoop stress, tension positive, stress
  double peak_angle = 0;      ///< where, degrees counter-clockwise from x
  double peak_error = 0;      ///< estimated; infinite where there is no degree below, stress
  /// The springs pull instead of pushing: they act on the side that does not bear.
  bool pulls = false;
  bool filled = false;  ///< springs act all around
  double pull = 0;      ///< largest tension of springs all around; 0 of those on an arc, stress
  /// Force that holds the disc across its one direction: the integral of the pressure around a whole circle. NaN of a
  /// part of one, whose disc a line of symmetry holds, and of discs that move along x and y.
  double across = std::numeric_limits<double>::quiet_NaN();
  double across_share = 0;  ///< over the bearing load, or over 1 % of the plate's largest force if that is more
  /// Friction of both components acts: its stresses are not those of friction along the force.
  bool by_components = false;
  bool in_tension = false;                                ///< the section of the concentrations
  double gross_concentration = 0, net_concentration = 0;  ///< over the section stress; 0 where the section is unloaded
};

/// Amounts of the unit cases of a plate's stresses, and the forces of its fasteners.
struct PlateLoading {
  Eigen::VectorXd amounts;   ///< (e + m + h + q) in the order of formats::PlateStresses
  Eigen::VectorXd bearing;   ///< (m) bearing force along each disc's direction on its rim, force
  Eigen::VectorXd friction;  ///< (m) friction resultant along it, force
};

/// States of all holes of a plate whose matrices hold stresses at the joint's degree, else none, by superposition.
///
/// The error of the peak is the largest change of the hoop stress from the degree below within 45 degrees of it
/// (tests/pipeline/peak_error_test.cpp). Points within 7.5 degrees of a jump of friction are no candidates for the peak
/// if the jump is more than 1 % of the bearing stress. The bypass load is the section force along x on the side of the
/// hole that bears (docs/theory.md, sections 11.2 to 11.4).
[[nodiscard]] std::vector<RimState> rim_states(const PlateModel& plate, const PlateLoading& loading);

}  // namespace fastjoint::stage3
