// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Bearing forces when every fastener is a linear spring.
struct LinearForces {
  Eigen::VectorXd F;        ///< (n a) force
  int solves = 0;           ///< with friction the sides that bear are found by trial
  bool consistent = false;  ///< friction acts on the sides that bear
};

/// Solves (I + S_ud diag(flexibility) + H E) F = lambda q, with the columns of H by the sides that bear
/// (docs/theory.md, section 8.8).
///
/// @param flexibility One for each row, length / force, >= 0, shape (n a); zero is a rigid fastener.
[[nodiscard]] LinearForces linear_forces(const CondensedSystem& system, const Eigen::VectorXd& flexibility,
                                         double load_factor);

/// Flexibilities of all rows if every plane is a linear spring without gap that bears both ways, shape (n a).
[[nodiscard]] std::optional<Eigen::VectorXd> linear_flexibility(const JointEquations& equations);

/// Bearing forces to start from (Bortman & Szabo, section 6.1): of rigid fasteners, of linear ones of one
/// stiffness (default: the mean of the plates' own, diag S_ud), or the rigid ones' sum spread equally over
/// the planes. Shape (n a), force.
[[nodiscard]] Eigen::VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial,
                                             double load_factor);

/// The user's guess, then the others, as contact coordinates; each of shape (n a), force.
[[nodiscard]] std::vector<Eigen::VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial,
                                                         double load_factor);

}  // namespace fastjoint::stage3
