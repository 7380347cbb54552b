// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Bearing forces when every fastener is a linear spring.
struct LinearForces {
  Eigen::VectorXd F;        ///< (n) force
  int solves = 0;           ///< with friction the sides that bear are found by trial
  bool consistent = false;  ///< friction acts on the sides that bear
};

/// Solves (I + S_ud diag(flexibility) + H) F = lambda q, with the columns of H by the signs of F.
///
/// @param flexibility Of each fastener, length / force, >= 0, shape (n); zero is a rigid fastener.
[[nodiscard]] LinearForces linear_forces(const CondensedSystem& system, const Eigen::VectorXd& flexibility,
                                         double load_factor);

/// Flexibilities of the fasteners if all of them are linear springs without gap that bear both ways, shape
/// (n).
[[nodiscard]] std::optional<Eigen::VectorXd> linear_flexibility(const std::vector<Contact>& contacts);

}  // namespace fastjoint::stage3
