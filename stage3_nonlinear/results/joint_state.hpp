// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/crack_state.hpp"
#include "stage3_nonlinear/results/hole_state.hpp"
#include "stage3_nonlinear/strength/plate_bending.hpp"

namespace fastjoint::stage3 {

/// One plate at one increment.
struct PlateState {
  VectorXd D;                      ///< (m) disc displacements, length
  VectorXd De, Pe;                 ///< (e) displacements of the rigid externals and forces on them, length, force
  VectorXd moments;                ///< (k) long waves of the rims of contact, length
  VectorXd w;                      ///< all waves of the disc's normal displacement at the rims of contact, length
  VectorXd waves;                  ///< coefficient of each loaded wave of its file, stress
  VectorXd added;                  ///< coefficients of all waves of contact that the fields use, stress
  VectorXd Lambda;                 ///< (h + s) peak stress of each friction case, then of each shear of contact, stress
  VectorXd traction;               ///< (q) force on each traction boundary, force
  VectorXd traction_displacement;  ///< (q) mean along each, length; infinite where friction cases act on the plate
  VectorXd bearing, friction;      ///< (m) resultants of the fasteners' bearing and friction on each disc, force
  // If its matrices hold stresses at the joint's degree: of every hole, and of rims with waves and a closed form.
  std::vector<HoleState> rims = {};
  std::vector<std::optional<LoadedRim>> loaded = {};
  CrackState cracks = {};
  PlateBending bending = {};
  // Resultants of the forces on the plate along x and y, force.
  Eigen::Vector2d applied{0, 0};       ///< by rigid externals and tractions
  Eigen::Vector2d by_fasteners{0, 0};  ///< bearing and friction
  Eigen::Vector2d by_supports{0, 0};   ///< minus the sum of both: the reaction of the supports of stage 1
};

/// The whole joint at one increment, from the plates' own matrices.
struct JointState {
  std::vector<PlateState> plates;
  /// (n) force that each plane transfers, with the friction of its first and of its second hole; the magnitude if the
  /// discs have two directions. Both are equal for a fastener in balance.
  VectorXd transferred_first, transferred_second;
  double largest_force = 0;  ///< of externals, tractions and fasteners, and PathStep::scale
  // Imbalances over the largest force.
  double out_of_balance = 0;            ///< largest row of S D + R Lambda + T f + B F - P
  double fasteners_out_of_balance = 0;  ///< largest resultant on a fastener that is not grounded
  /// Largest resultant of a plate along an axis without supports according to its file; none without such an axis.
  std::optional<double> plates_out_of_balance;
  // Results of Bending, by free and by clamped heads; none without secondary bending.
  MatrixXd bending_mismatch = MatrixXd(0, 2);  ///< (2, 2) of the moments along x, y
  const char* no_bending = nullptr;            ///< why some of it is not known; null if all is
  MatrixXd bent_transferred = MatrixXd(0, 2);  ///< (n, 2) as transferred_first, force
};

/// Sets the state of the rims of a plate, `w`, `waves`, `added` and `loaded`, from its displacements, Lambda and
/// tractions.
/// @param contacts One for each rim of contact.
void load_rims(const PlateModel& plate, std::vector<ContactLoad> contacts, PlateState& state,
               bool with_stresses = true);

/// Displacements of all unknowns, (N, columns), length, from the loads of the load columns, (l, columns), relative
/// displacements of planes and moments, (r, columns), and amplitudes of friction, (t, columns).
[[nodiscard]] MatrixXd displacements(const JointModel& joint, const CondensedSystem& system, const MatrixXd& load,
                                     const MatrixXd& delta, const MatrixXd& Lambda);

/// State of each plate from loads, displacements and friction: D, De, moments, Lambda, tractions and forces Pe, and the
/// results of load_rims.
/// @param contacts One for each rim of contact of all plates. @param D (N).
[[nodiscard]] std::vector<PlateState> plate_loads(const JointModel& joint, const CondensedSystem& system,
                                                  const std::vector<ContactLoad>& contacts, const VectorXd& D,
                                                  const VectorXd& load, const VectorXd& Lambda,
                                                  bool with_stresses = true);

/// Mean displacements of the traction boundaries of a plate, (q), length, under the displacements u of its unknowns and
/// the forces f of its tractions, without what friction cases add.
[[nodiscard]] VectorXd traction_displacements(const PlateModel& plate, const VectorXd& u, const VectorXd& f);

/// @param with_stresses Else without stresses at holes and cracks, only forces and displacements.
[[nodiscard]] JointState joint_state(const JointModel& joint, const JointEquations& equations, const PathStep& step,
                                     bool with_stresses = true);

/// Share of each plane in per cent of the sum over all planes between the same two plates, or a plate and the ground,
/// in either order, shape (n); NaN if the sum is only rounding.
[[nodiscard]] VectorXd shares(const JointModel& joint, const VectorXd& transferred);

}  // namespace fastjoint::stage3
