// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Bearing forces when every fastener is a linear spring.
struct LinearForces {
  VectorXd F;               ///< (r) force
  bool consistent = false;  ///< friction acts on the bearing sides, which are found by trial
};

/// Solves (I + S_ud diag(flexibility) + H E) F = lambda q, with the columns of H for the bearing sides (docs/theory.md,
/// section 8.8).
///
/// @param flexibility One for each row, length / force, >= 0, shape (r); zero is a rigid fastener.
[[nodiscard]] LinearForces linear_forces(const JointEquations& equations, const VectorXd& flexibility,
                                         double load_factor);

/// Bearing forces to start from (Bortman & Szabo, section 6.1), shape (r), force: those of rigid fasteners, those of
/// linear ones of one stiffness (default: the mean of the plates' own, diag S_ud), or the mean of the rigid ones; the
/// springs of rims are taken as linear.
[[nodiscard]] VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor);

/// Contact coordinates at which the bearing forces are approximately F, (r), force.
[[nodiscard]] VectorXd guessed_coordinates(const JointEquations& equations, const VectorXd& F);

/// The user's guess, then the others.
[[nodiscard]] std::vector<InitialScene> guesses_in_order(const InitialScene& initial);

/// The same for the forces of a guess.
[[nodiscard]] VectorXd first_guess(const JointEquations& equations, const InitialScene& guess, double load_factor);

}  // namespace fastjoint::stage3
