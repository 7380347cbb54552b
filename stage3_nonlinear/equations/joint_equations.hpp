// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/equations/contact.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// The nonlinear equations of a joint: the condensed system with the fasteners' laws put in, for the contact
/// coordinates c.
struct JointEquations {
  CondensedSystem system;
  std::vector<Contact> contacts;  ///< (n)
  /// Inverse of W = K - S_ud, K the reference stiffnesses, if no law falls, else empty; shape (n a, n a),
  /// length / force (docs/theory.md, section 8.4).
  MatrixXd metric;

  [[nodiscard]] Index n_planes() const { return contacts.size(); }
  /// Number a of directions.
  [[nodiscard]] Index n_directions() const { return n_unknowns() / n_planes(); }
  /// Number n a of unknowns.
  [[nodiscard]] Index n_unknowns() const { return system.q.size(); }
};

/// Condenses the plates and gives each plane, as its reference stiffness, a little more than the sum of the amounts in
/// its row of S_ud, so that K - S_ud is positive definite (docs/theory.md, section 8.2). Where S_ud is nothing but
/// rounding, the plate's own stiffness takes its place.
[[nodiscard]] JointEquations make_equations(const JointModel& joint);
/// @param contacts Contacts whose stiffness is that of the plate itself, and is replaced.
[[nodiscard]] JointEquations make_equations(CondensedSystem system, std::vector<Contact> contacts);

/// Derivative of the residual by c, shape (n a, n a), at the state of the contact coordinates c.
///
/// @param friction False: without that of friction.
[[nodiscard]] MatrixXd tangent(const CondensedSystem& system, const ContactState& state, bool friction = true);

/// Hessian of the convex function whose gradient is metric * residual, W^-1 - d delta / dc, symmetric, shape (n a,
/// n a), length / force; the tangent is W times it (docs/theory.md, section 8.4). To be called where no law falls.
[[nodiscard]] MatrixXd hessian(const JointEquations& equations, const ContactState& state);

/// The equations at a load factor, unknowns and residuals over `scale` (force).
///
/// @param frozen If not null, friction acts as under these bearing forces instead of its own, (n a).
[[nodiscard]] RootProblem root_problem(const JointEquations& equations, double load_factor, double scale,
                                       const VectorXd* frozen = nullptr);

/// Bearing forces when every fastener is a linear spring.
struct LinearForces {
  VectorXd F;               ///< (n a) force
  int solves = 0;           ///< with friction the sides that bear are found by trial
  bool consistent = false;  ///< friction acts on the sides that bear
};

/// Solves (I + S_ud diag(flexibility) + H E) F = lambda q, with the columns of H by the sides that bear
/// (docs/theory.md, section 8.8).
///
/// @param flexibility One for each row, length / force, >= 0, shape (n a); zero is a rigid fastener.
[[nodiscard]] LinearForces linear_forces(const CondensedSystem& system, const VectorXd& flexibility,
                                         double load_factor);

/// Bearing forces to start from (Bortman & Szabo, section 6.1): of rigid fasteners, of linear ones of one
/// stiffness (default: the mean of the plates' own, diag S_ud), or the rigid ones' sum spread equally over
/// the planes. Shape (n a), force.
[[nodiscard]] VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor);

/// The user's guess, then the others, as contact coordinates; each of shape (n a), force.
[[nodiscard]] std::vector<VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial,
                                                  double load_factor);

}  // namespace fastjoint::stage3
