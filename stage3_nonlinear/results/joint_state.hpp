// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/rim_state.hpp"

namespace fastjoint::stage3 {

/// One plate at one increment.
struct PlateState {
  VectorXd D;                  ///< (m) disc displacements, length
  VectorXd De, Pe;             ///< (e) displacements of the rigid externals and forces on them, length, force
  VectorXd moments;            ///< (k) long waves of the rims of contact, length
  VectorXd w;                  ///< all waves of the disc's normal displacement at the rims of contact, length
  VectorXd waves;              ///< amount of each loaded wave of its file, stress
  VectorXd added;              ///< the same of all waves of contact by which fields are made, stress
  VectorXd Lambda;             ///< (h + s) peak stress of each friction case, then of each shear of contact, stress
  VectorXd traction;           ///< (q) force on each traction boundary, force
  VectorXd bearing, friction;  ///< (m) resultants of the fasteners' bearing and friction on each disc, force
  // Of every hole, and of those with waves and a closed form, if its matrices hold stresses at the joint's degree:
  std::vector<RimState> rims = {};
  std::vector<std::optional<LoadedRim>> loaded = {};
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
  VectorXd transferred_first, transferred_second;
  double largest_force = 0;  ///< of externals, tractions and fasteners, and PathStep::scale
  // Over the largest force:
  double out_of_balance = 0;            ///< worst row of S D + R Lambda + T f + B F - P
  double fasteners_out_of_balance = 0;  ///< worst sum of what the holes of one without ground give it
  /// Worst sum of all forces on a plate along an axis along which its file says that nothing supports it; none if there
  /// is none.
  std::optional<double> plates_out_of_balance;
};

/// Sets what the loads on a plate make of its rims, `w`, `waves`, `added` and `loaded`, by its displacements, Lambda
/// and tractions.
/// @param contacts Of the rims of contact.
void load_rims(const PlateModel& plate, std::vector<ContactLoad> contacts, PlateState& state);

/// Displacements of all unknowns, (N, columns), length, by amounts of the load cases, (l, columns), relative
/// displacements of planes and moments, (r, columns), and amounts of friction, (t, columns).
[[nodiscard]] MatrixXd displacements(const JointModel& joint, const CondensedSystem& system, const MatrixXd& load,
                                     const MatrixXd& delta, const MatrixXd& Lambda);

/// What loads, displacements and friction make of each plate: D, De, moments, Lambda, tractions and forces Pe, and what
/// load_rims adds.
/// @param rims Of contact, of all plates. @param D (N).
[[nodiscard]] std::vector<PlateState> plate_loads(const JointModel& joint, const CondensedSystem& system,
                                                  const std::vector<ContactLoad>& contacts, const VectorXd& D,
                                                  const VectorXd& load, const VectorXd& Lambda);

[[nodiscard]] JointState joint_state(const JointModel& joint, const JointEquations& equations, const PathStep& step);

/// Shares in per cent of the sum over all planes between the same two plates, or a plate and the ground, whichever
/// their fasteners name first, shape (n); NaN where the sum is nothing but rounding.
[[nodiscard]] VectorXd shares(const JointModel& joint, const VectorXd& transferred);

}  // namespace fastjoint::stage3
