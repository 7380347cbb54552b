// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/exact.hpp"

#include <cmath>

namespace fastjoint::test {
namespace {

/// Columns e_r and e_theta.
Eigen::Matrix2d polar_frame(double theta) {
  Eigen::Matrix2d Q;
  Q << std::cos(theta), -std::sin(theta), std::sin(theta), std::cos(theta);
  return Q;
}

}  // namespace

Eigen::Vector2d SpringInclusion::displacement(const Eigen::Vector2d& x) const {
  const double r = x.norm();
  const double theta = std::atan2(x.y(), x.x());
  const double c = std::cos(2 * theta);
  const double s = std::sin(2 * theta);
  const double a2 = a_ * a_ / r;
  const double a4 = std::pow(a_, 4) / std::pow(r, 3);
  const double radial = r * ((1 - nu_) + (1 + nu_) * c) - (1 + nu_) * A_ * a2 - (B_ * a2 + (1 + nu_) * C_ / 3 * a4) * c;
  const double around = (-(1 + nu_) * r + B_ / 2 * (1 - nu_) * a2 - (1 + nu_) * C_ / 3 * a4) * s;
  return s_ / (2 * E_) * polar_frame(theta) * Eigen::Vector2d(radial, around);
}

Eigen::Matrix2d SpringInclusion::stress(const Eigen::Vector2d& x) const {
  const double theta = std::atan2(x.y(), x.x());
  const double c = std::cos(2 * theta);
  const double s = std::sin(2 * theta);
  const double rho2 = a_ * a_ / x.squaredNorm();
  const double rho4 = rho2 * rho2;
  Eigen::Matrix2d sigma;
  sigma(0, 0) = 1 + A_ * rho2 + (1 + B_ * rho2 + C_ * rho4) * c;
  sigma(1, 1) = 1 - A_ * rho2 - (1 + C_ * rho4) * c;
  sigma(0, 1) = sigma(1, 0) = -(1 - B_ / 2 * rho2 - C_ * rho4) * s;
  const Eigen::Matrix2d Q = polar_frame(theta);
  return s_ / 2 * Q * sigma * Q.transpose();
}

}  // namespace fastjoint::test
