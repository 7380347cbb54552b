// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/condensed_system.hpp"
#include "stage3_nonlinear/contact.hpp"

namespace fastjoint::stage3 {

/// The nonlinear equations of a joint: the condensed system with the fasteners' laws put in.
struct JointEquations {
  CondensedSystem system;
  std::vector<Contact> contacts;  ///< (n)

  [[nodiscard]] Eigen::Index n_fasteners() const { return system.q.size(); }
};

/// Condenses the plates and gives each fastener the plates' stiffness at its place as its reference
/// stiffness.
[[nodiscard]] JointEquations make_equations(const JointModel& joint);

/// d residual / d c, shape (n, n), at the state of the contact coordinates c.
[[nodiscard]] Eigen::MatrixXd tangent(const CondensedSystem& system, const ContactState& state);

/// Fasteners that are open while the tangent is singular: nothing but them holds some plate, so that its
/// place within their gaps is not determined. Empty if all is well.
[[nodiscard]] std::vector<Eigen::Index> undetermined(const CondensedSystem& system, const ContactState& state);

}  // namespace fastjoint::stage3
