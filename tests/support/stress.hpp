// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "tests/support/plates.hpp"

namespace fastjoint::test {

/// Coefficients of every global function, shape (2, n_functions): the free unknowns of one degree, zeros for the
/// others, and the controlled displacements.
[[nodiscard]] Eigen::Matrix2Xd coefficients(const Plate& plate, const Eigen::VectorXd& free,
                                            const Eigen::VectorXd& controlled);

/// Finite element stress (sigma_x, sigma_y, tau_xy) at a point of an element.
[[nodiscard]] Eigen::Vector3d stress_at(const Plate& plate, const Eigen::Matrix2Xd& u, int element, double xi,
                                        double eta);

/// Force along x on the side x = const named `set`, by integrating sigma_x t over it: what must not be used, kept to
/// measure how much worse it is.
[[nodiscard]] double integrated_force(const Plate& plate, const Eigen::Matrix2Xd& u, const std::string& set);

}  // namespace fastjoint::test
