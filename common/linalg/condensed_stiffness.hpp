// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::linalg {

/// Condensed stiffness S = E_c E_c^T - diag(shift), shape (nc, nc), force / length: S_ij is the force on i per
/// displacement of j, and the energy product of the unit fields i and j, which makes it superconvergent
/// (docs/theory.md, sections 4.1 and 4.4; Babuska & Miller, Int. J. Numer. Meth. Engng 20, 1085, 1984). S is zero where
/// rounding is all that is left of K_cc, as in a sheet held by one disc alone.
[[nodiscard]] Eigen::MatrixXd condensed_stiffness(const Eigen::MatrixXd& E_c, const Eigen::VectorXd& shift,
                                                  const Eigen::MatrixXd& K_cc);

}  // namespace fastjoint::linalg
