// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/equations/contact.hpp"
#include "stage3_nonlinear/equations/rim_contact.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// The nonlinear equations of a joint: the condensed system with the fasteners' laws put in, for the contact
/// coordinates c: those of the n shear planes in a directions, then for each rim of contact its stiffness times its
/// moments, r in all.
struct JointEquations {
  CondensedSystem system;
  std::vector<Contact> contacts;  ///< (n)
  /// Inverse of W = K - S_ud of the planes, K the reference stiffnesses, if no law falls, else empty; shape (n a, n a),
  /// length / force. With it the solution is where a convex function is least (docs/theory.md, section 8.4).
  MatrixXd metric;
  std::vector<RimContact> rims = {};

  [[nodiscard]] Index n_planes() const { return contacts.size(); }
  /// Number a of directions.
  [[nodiscard]] Index n_directions() const { return n_plane_rows() / n_planes(); }
  /// Number n a of unknowns of the planes.
  [[nodiscard]] Index n_plane_rows() const;
  /// Number r of unknowns.
  [[nodiscard]] Index n_unknowns() const { return system.q.size(); }
  /// Plane of an unknown, or number of planes plus rim of contact.
  [[nodiscard]] Index entry_of(Index row) const;
  /// Numbers of moments of the rims, rim after rim.
  [[nodiscard]] std::vector<Index> rim_sizes() const;
  /// Stiffness of the rims' unknowns, (r - n a), force / length.
  [[nodiscard]] VectorXd rim_stiffness() const;
  /// True if a disc is larger than the rim of contact around it.
  [[nodiscard]] bool has_interference() const;
  /// Force that the greatest clearance would take of the plates beside it, and the greatest gap or interference of the
  /// springs of its rim, force.
  [[nodiscard]] double force_of_clearances() const;
  [[nodiscard]] double force_of_gaps() const;
};

/// Condenses the plates and gives each plane, as its reference stiffness, a little more than the sum of the amounts in
/// its row of S_ud, so that K - S_ud is positive definite (docs/theory.md, section 8.2). Where S_ud is nothing but
/// rounding, the plate's own stiffness takes its place.
[[nodiscard]] JointEquations make_equations(const JointModel& joint);
/// @param contacts Contacts whose stiffness is that of the plate itself, and is replaced.
[[nodiscard]] JointEquations make_equations(CondensedSystem system, std::vector<Contact> contacts,
                                            std::vector<RimContact> rims = {});

/// @param c Contact coordinates, shape (r), force.
[[nodiscard]] ContactState contact_state(const JointEquations& equations, const VectorXd& c);

/// Gradients at the residuals, (r, columns), of the convex function that `metric` makes.
[[nodiscard]] MatrixXd gradient(const JointEquations& equations, const MatrixXd& residuals);

/// Adds the derivative of the forces of friction at rims of contact by c, dimensionless, to J, (r, r).
void add_shear_slopes(const CondensedSystem& system, const ContactState& state, MatrixXd& J);

/// Derivative of the residual by c, shape (r, r), at the state of the contact coordinates c.
///
/// @param friction False: without that of friction.
[[nodiscard]] MatrixXd tangent(const CondensedSystem& system, const ContactState& state, bool friction = true);

/// Hessian of that convex function of a joint without rims of contact, symmetric, shape (r, r), length / force:
/// W^-1 - d delta / dc, and the tangent is W times it (docs/theory.md, section 8.4). To be called where no law falls.
[[nodiscard]] MatrixXd hessian(const JointEquations& equations, const ContactState& state);

/// The equations at a load factor, unknowns and residuals over `scale` (force).
///
/// @param frozen If not null, friction acts as in this state instead of its own.
[[nodiscard]] RootProblem root_problem(const JointEquations& equations, double load_factor, double scale,
                                       const ContactState* frozen = nullptr);

/// Bearing forces when every fastener is a linear spring.
struct LinearForces {
  VectorXd F;               ///< (r) force
  int solves = 0;           ///< with friction the sides that bear are found by trial
  bool consistent = false;  ///< friction acts on the sides that bear
};

/// Solves (I + S_ud diag(flexibility) + H E) F = lambda q, with the columns of H by the sides that bear
/// (docs/theory.md, section 8.8).
///
/// @param flexibility One for each row, length / force, >= 0, shape (r); zero is a rigid fastener.
/// @param rims JointEquations::rim_sizes.
[[nodiscard]] LinearForces linear_forces(const CondensedSystem& system, const VectorXd& flexibility, double load_factor,
                                         const std::vector<Index>& rims = {});

/// Bearing forces to start from (Bortman & Szabo, section 6.1): of rigid fasteners, of linear ones of one
/// stiffness (default: the mean of the plates' own, diag S_ud), or the rigid ones' sum spread equally over
/// the planes; rims as if their springs also pulled. Shape (r), force.
[[nodiscard]] VectorXd guessed_forces(const JointEquations& equations, const InitialScene& initial, double load_factor);

/// Contact coordinates at which the bearing forces are F, or about that, (r), force.
[[nodiscard]] VectorXd guessed_coordinates(const JointEquations& equations, const VectorXd& F);

/// The user's guess, then the others, as contact coordinates; each of shape (r), force.
[[nodiscard]] std::vector<VectorXd> first_guesses(const JointEquations& equations, const InitialScene& initial,
                                                  double load_factor);

}  // namespace fastjoint::stage3
