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

}  // namespace fastjoint::pfem
