// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/contact/rim_gap.hpp"

namespace fastjoint::stage1 {

/// Arcs on which the springs of one hole push under the scene's loads.
struct RimContact {
  int hole;               ///< index into PlateScene::holes
  Arcs arcs;              ///< where they push
  int iterations;         ///< until the ends of the arcs stood still
  double last_move;       ///< by how much the farthest of them still moved in the last iteration, radians
  double peak_pressure;   ///< stress; 0 if the rim is free
  double peak_angle;      ///< where, radians
  double half_angle = 0;  ///< radians, of one arc symmetric about the force on the disc (of half an arc that a line of
                          ///< symmetry cuts there), else 0
};

/// Unilateral contact under the scene's loads, and the loads as amounts of the unit cases.
struct RimContactState {
  std::vector<RimContact> holes;
  Eigen::VectorXd displacement;  ///< (nc) of externals, then discs
  Eigen::VectorXd force;         ///< (nc) on them from outside; of a disc, what its springs transmit
  Eigen::VectorXd friction;      ///< (h) amplitudes, stress
  Eigen::VectorXd traction;      ///< (q) force
};

/// Finds the arcs on which springs push but do not pull, and the state of the plate under the scene's loads.
///
/// Each iteration solves with springs on the present arcs and takes as next arcs where the disc presses on the rim,
/// until no end moves by more than 1e-6 rad: Newton's method (docs/theory.md, section 6.5). The first arcs are the
/// halves that bear under the forces on the discs when all springs act.
/// @param problem Of the scene with the whole rims sprung.
/// Throws NumericalError if contact is lost or the arcs do not come to rest.
[[nodiscard]] RimContactState find_contact(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
                                           int most_iterations = 50);

/// The scene with springs on the found arcs only: an ordinary linear plate.
[[nodiscard]] PlateScene with_arcs(PlateScene scene, const RimContactState& state);

}  // namespace fastjoint::stage1
