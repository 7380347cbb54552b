// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/equations/contact.hpp"
#include "stage3_nonlinear/interfaces/rim_problem.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// The nonlinear equations of a joint for the parameters of one run: the condensed system and the interfaces, with the
/// contact coordinates c = F + k delta as unknowns: those of the n shear planes in a directions, then those of the long
/// waves of each rim of contact, r in all.
struct JointEquations {
  std::shared_ptr<const CondensedSystem> system;
  Parameters parameters;
  std::vector<Contact> contacts;                        ///< (n)
  std::vector<std::shared_ptr<const RimProblem>> rims;  ///< (g)
  std::vector<PlacedInterface> interfaces;              ///< fastener after fastener, then rim after rim
  VectorXd q, q_reversed;             ///< (r) q_at for load factors > 0, and < 0, if it starts unloaded; force
  bool rises = true;                  ///< no law falls
  bool has_friction = false;          ///< in any interface
  bool has_cosine_friction = false;   ///< some friction follows from the bearing forces of a fastener
  std::vector<History> history = {};  ///< of each interface, at the start of the increment; empty: none yet

  [[nodiscard]] Index n_planes() const { return contacts.size(); }
  /// Number a of directions.
  [[nodiscard]] Index n_directions() const { return n_planes() > 0 ? n_plane_rows() / n_planes() : 1; }
  /// Number n a of unknowns of the planes.
  [[nodiscard]] Index n_plane_rows() const { return n_unknowns() - system->n_moments(); }
  /// Number r of unknowns.
  [[nodiscard]] Index n_unknowns() const { return system->S_ud.rows(); }
  /// Index of the plane of an unknown, or number of planes plus index of the rim of contact.
  [[nodiscard]] Index entry_of(Index row) const;
  /// Coordinates of a rim of contact, (n_long).
  [[nodiscard]] VectorXd of_rim(const VectorXd& c, Index rim) const;
  /// True if a disc is larger than the rim of contact around it.
  [[nodiscard]] bool has_interference() const {
    return std::ranges::any_of(rims, [](const auto& rim) { return rim->contact().gap() < 0; });
  }
  /// Largest force that would deform the plates by a clearance, or the springs of a rim by its gap or interference,
  /// force.
  [[nodiscard]] double force_of_clearances() const;
  /// The same by gaps alone. @param interference_alone If true, only rims with interference count, which acts without
  /// load.
  [[nodiscard]] double force_of_gaps(bool interference_alone = false) const;
  /// Largest force that would take the permanent set of a plane, 0 without memory.
  [[nodiscard]] double force_of_sets() const;
  /// Largest force that would push the free sheets together, plane by plane, force.
  [[nodiscard]] double force_of_offsets() const;
  /// Derivative of the forces of rigid fasteners by the load factor, (r).
  [[nodiscard]] VectorXd q_at(double load_factor) const;
  /// Updates the histories of the interfaces with the solution of an increment, the contact coordinates c, (r).
  void commit(const VectorXd& c);
  /// What the planes remember, (n); empty if no law remembers.
  [[nodiscard]] std::vector<PlaneMemory> memories() const;
  /// True if a law remembers.
  [[nodiscard]] bool remembers() const {
    return std::ranges::any_of(contacts, [](const Contact& each) { return each.law->remembers(); });
  }
  /// True if there is no load at load factor 0.
  [[nodiscard]] bool starts_unloaded() const { return !parameters.starts_loaded(); }
  /// Relative displacements of the planes and moments of a solution less the offsets: what deforms the sheets, (r).
  [[nodiscard]] VectorXd deforming(const VectorXd& delta) const;
  /// Forces of rigid fasteners at a load factor, with those by the free shapes of the sheets: S_ud times the offsets of
  /// the planes, (r), force.
  [[nodiscard]] VectorXd rigid_forces(double load_factor) const;
  /// Loads of the load columns at a load factor, and their derivatives by it, (l).
  [[nodiscard]] VectorXd load_at(double load_factor) const {
    return of_active_columns(load_factor, parameters.load_at(load_factor));
  }
  [[nodiscard]] VectorXd load_rates(double load_factor) const {
    return of_active_columns(load_factor, parameters.load);
  }
  /// Values of the load columns, (l), from a value of each load; zero for columns that are not active at a load factor.
  [[nodiscard]] VectorXd of_active_columns(double load_factor, const VectorXd& values) const;
  /// F + S_ud delta and, with friction, H Lambda, (r), force.
  [[nodiscard]] VectorXd required(const ContactState& state, bool friction) const;
  /// F + S_ud delta + H Lambda minus the forces of rigid fasteners, (r), force.
  [[nodiscard]] VectorXd residual(const ContactState& state, double load_factor) const {
    return required(state, has_friction) - rigid_forces(load_factor);
  }
  /// Derivative of the forces H Lambda of cosine friction by F for the sides that bear under F, (r, r), dimensionless.
  [[nodiscard]] MatrixXd friction_matrix(const VectorXd& F) const;
};

/// @param system Condensed system of the joint, held as in the parameters.
/// @param like Rims of other equations of the same joint to copy from; the new rims start at their last solutions.
[[nodiscard]] JointEquations make_equations(const JointModel& joint, std::shared_ptr<const CondensedSystem> system,
                                            Parameters parameters,
                                            const std::vector<std::shared_ptr<const RimProblem>>& like = {});

/// @param c Contact coordinates, shape (r), force.
[[nodiscard]] ContactState contact_state(const JointEquations& equations, const VectorXd& c);

/// The equations at a load factor, with unknowns and residuals divided by `scale` (force).
///
/// @param frozen If not null, friction is constant and that of this state.
[[nodiscard]] RootProblem root_problem(const JointEquations& equations, double load_factor, double scale,
                                       const ContactState* frozen = nullptr);

}  // namespace fastjoint::stage3
