// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/pfem/element_map.hpp"
#include "common/pfem/space.hpp"

namespace fastjoint::pfem {

/// Strains of an element per coefficient, shape (3 n_points, 2 n_modes): rows (eps_x, eps_y, gamma_xy) point after
/// point, first the coefficients of u_x, then those of u_y, local signs.
/// @param xi, eta Coordinates of the points, each of shape (n_points).
[[nodiscard]] Eigen::MatrixXd strain_operator(const ElementMap& map, Space space, int p, const Eigen::VectorXd& xi,
                                              const Eigen::VectorXd& eta);

/// Coordinates (xi, eta) of points along a local edge, shape (2, n_points).
/// @param s Coordinates along the edge's natural direction, shape (n_points).
[[nodiscard]] Eigen::Matrix2Xd along_edge(int local_edge, const Eigen::VectorXd& s);

/// Turns stresses (sigma_x, sigma_y, tau_xy) into (sigma_rr, sigma_tt, sigma_rt) at the angle theta, radians
/// counter-clockwise from x, shape (3, 3). Its inverse is that at -theta.
[[nodiscard]] Eigen::Matrix3d polar_stress(double theta);

}  // namespace fastjoint::pfem
