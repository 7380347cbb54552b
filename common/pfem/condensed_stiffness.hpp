// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::pfem {

/// S_ij = energy product of the unit fields i and j, shape (nc, nc), force / length, by their coordinates in a basis
/// that is orthonormal in energy: S = E_c E_c^T - diag(shift). Its error is the product of two energy-norm errors;
/// integrating the stresses along the boundaries instead would converge at half the rate. S_ij is the force on i per
/// displacement of j. Where rounding is all that is left of K_cc, as of a sheet that one disc alone holds, S is zero.
/// Theory: Babuska & Miller, Int. J. Numer. Meth. Engng 20, 1085 (1984).
[[nodiscard]] Eigen::MatrixXd condensed_stiffness(const Eigen::MatrixXd& E_c, const Eigen::VectorXd& shift,
                                                  const Eigen::MatrixXd& K_cc);

}  // namespace fastjoint::pfem
