// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Bearing forces to start from (Bortman & Szabo, section 6.1): of rigid fasteners, of linear ones of one
/// stiffness (default: the mean of the plates' own, diag S_ud), or the rigid ones' sum spread equally over
/// the planes. Shape (n a), force.
[[nodiscard]] Eigen::VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial,
                                             double load_factor);

/// The user's guess, then the others, as contact coordinates; each of shape (n a), force.
[[nodiscard]] std::vector<Eigen::VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial,
                                                         double load_factor);

}  // namespace fastjoint::stage3
