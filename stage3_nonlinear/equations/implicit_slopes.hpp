// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Derivatives of the bearing forces as vectors, one column for each number (docs/theory.md, section 10).
struct Slopes {
  Eigen::MatrixXd F;                            ///< (n a, columns)
  std::vector<Eigen::Index> no_column, no_row;  ///< columns and rows of F that have no derivative
};

/// Contact coordinates of a solution, (n a), exact whatever the law.
[[nodiscard]] Eigen::VectorXd coordinates(const std::vector<Contact>& contacts, const Eigen::VectorXd& F,
                                          const Eigen::VectorXd& delta);

/// Slopes by the implicit function theorem: dF = F_c dc with J dc = -residual, at a solution.
/// @param residual Rise of the residual of the condensed system at fixed c, force, shape (n a, columns).
[[nodiscard]] Slopes implicit_slopes(const CondensedSystem& system, const ContactState& state,
                                     const Eigen::MatrixXd& residual);

/// Replaces the forces without load, under which no rim bears yet, by those of a small load, whose sides tell how
/// friction acts.
void bear(const JointEquations& equations, ContactState& state);

/// Slopes of the forces' amounts, (n, columns); infinite where they do not exist.
[[nodiscard]] Eigen::MatrixXd of_amounts(const Slopes& slopes, const ContactState& state, const Eigen::VectorXd& c);

}  // namespace fastjoint::stage3
