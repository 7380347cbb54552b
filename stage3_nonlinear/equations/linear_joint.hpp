// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

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
/// @param flexibility Of each row, length / force, >= 0, shape (n a); zero is a rigid fastener.
[[nodiscard]] LinearForces linear_forces(const CondensedSystem& system, const Eigen::VectorXd& flexibility,
                                         double load_factor);

/// Flexibilities of all rows if every plane is a linear spring without gap that bears both ways, shape (n a).
[[nodiscard]] std::optional<Eigen::VectorXd> linear_flexibility(const JointEquations& equations);

}  // namespace fastjoint::stage3
