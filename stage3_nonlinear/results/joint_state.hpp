// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

namespace fastjoint::stage3 {

/// One hole of a plate at one increment: what RESULT.h5 holds, and what only the summary and warnings need.
struct RimState : formats::RimValues {
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
  bool in_tension = false;  ///< the section of the concentrations
};

/// One plate at one increment.
struct PlateState {
  Eigen::VectorXd D;                  ///< (m) disc displacements, length
  Eigen::VectorXd De, Pe;             ///< (e) displacements of the rigid externals and forces on them, length, force
  Eigen::VectorXd Lambda;             ///< (h) peak stress of each friction case, stress
  Eigen::VectorXd traction;           ///< (q) force on each traction boundary, force
  Eigen::VectorXd bearing, friction;  ///< (m) resultants of the fasteners' bearing and friction on each disc, force
  std::vector<RimState> rims = {};    ///< of every hole that the plate's stresses know
  // Sums of the forces that act on the plate along x and y, force.
  Eigen::Vector2d applied{0, 0};       ///< by rigid externals and tractions
  Eigen::Vector2d by_fasteners{0, 0};  ///< bearing and friction
  Eigen::Vector2d by_supports{0, 0};   ///< the remainder: what stage 1's supports must give
};

/// The whole joint at one increment, from the plates' own matrices.
struct JointState {
  std::vector<PlateState> plates;
  /// Force that each plane transfers, friction included, by that of its first and of its second hole, by amount where
  /// the discs have two directions, (n), force; a fastener in balance transfers one and the same.
  Eigen::VectorXd transferred_first, transferred_second;
  double largest_force = 0;  ///< of externals, tractions and fasteners
  // Over the largest force:
  double out_of_balance = 0;            ///< worst row of S D + R Lambda + T f + B F - P
  double fasteners_out_of_balance = 0;  ///< worst sum of what the holes of a fastener give it
  /// Worst sum of all forces on a plate along an axis along which nothing supports it; none if there is none.
  std::optional<double> plates_out_of_balance;
};

/// The states of all steps. A path whose forces do not balance, to 1e-8 of the largest or to what the solver's
/// tolerance leaves, ends there: rounding carries load.
[[nodiscard]] std::vector<JointState> balanced_states(const JointModel& joint, const CondensedSystem& system,
                                                      double tolerance, LoadPath& path);

[[nodiscard]] JointState joint_state(const JointModel& joint, const CondensedSystem& system, const PathStep& step);

/// States of all holes of a plate whose matrices hold stresses at the joint's degree, else none, by superposition.
///
/// The error of the peak is the largest change of the hoop stress from the degree below within 45 degrees of it
/// (tests/pipeline/peak_error_test.cpp). Points within 7.5 degrees of a jump of friction are no candidates for the peak
/// if the jump is more than 1 % of the bearing stress. The bypass load is the section force along x on the side of the
/// hole that bears (docs/theory.md, sections 11.2 to 11.4).
/// @param amounts      (e + m + h + q) of the unit cases, in the order of formats::PlateStresses.
/// @param all_bearing  (m) bearing force along each disc's direction on its rim, force.
/// @param all_friction (m) friction resultant along it, force.
[[nodiscard]] std::vector<RimState> rim_states(const PlateModel& plate, const Eigen::VectorXd& amounts,
                                               const Eigen::VectorXd& all_bearing, const Eigen::VectorXd& all_friction);

/// Shares in per cent of the sum over all planes between the same two plates, whichever their fasteners name first,
/// shape (n); NaN where the sum is nothing but rounding.
[[nodiscard]] Eigen::VectorXd shares(const JointModel& joint, const Eigen::VectorXd& transferred);

}  // namespace fastjoint::stage3
