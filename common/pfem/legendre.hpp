// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::pfem {

/// Points and weights of a quadrature on [-1, 1], each of shape (n).
struct Rule {
  Eigen::VectorXd x, w;
};

/// Gauss-Legendre rule of n points, exact for polynomials of degree 2 n - 1; n >= 1.
[[nodiscard]] Rule gauss(int n);

/// Legendre polynomials P_0 ... P_p at points x, shape (p + 1, n_points).
[[nodiscard]] Eigen::MatrixXd legendre(int p, const Eigen::VectorXd& x);

/// Values and derivatives of functions at points, each of shape (n_functions, n_points).
struct Values {
  Eigen::MatrixXd N, dN;
};

/// Hierarchic shape functions on [-1, 1]: the two linear ones, then integrated Legendre polynomials.
///
/// N_0 = (1-x)/2, N_1 = (1+x)/2, N_k = phi_k = (P_k - P_{k-2}) / sqrt(2 (2k-1)) for k >= 2, so that
/// int phi_i' phi_j' dx = delta_ij. Szabo & Babuska, Finite Element Analysis, Wiley 1991, section 6.1.
///
/// @param p Polynomial degree, p >= 1.
/// @param x Points in [-1, 1], shape (n_points).
/// @return  Shape (p + 1, n_points).
[[nodiscard]] Values integrated_legendre(int p, const Eigen::VectorXd& x);

}  // namespace fastjoint::pfem
