// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/material.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace fastjoint::pfem {
namespace {

/// Compliance of the normal strains along the material axes that are free in the analysis: three in plane strain, two
/// in plane stress.
Eigen::MatrixXd compliance(const OrthotropicConstants& c, Analysis analysis) {
  Eigen::Matrix3d s;
  s << 1 / c.E1, -c.nu12 / c.E1, -c.nu13 / c.E1,  //
      -c.nu12 / c.E1, 1 / c.E2, -c.nu23 / c.E2,   //
      -c.nu13 / c.E1, -c.nu23 / c.E2, 1 / c.E3;
  return analysis == Analysis::plane_strain ? Eigen::MatrixXd(s) : s.topLeftCorner(2, 2);
}

}  // namespace

OrthotropicConstants isotropic(double E, double nu) { return {E, E, E, nu, nu, nu, E / (2 * (1 + nu))}; }

bool is_stable(const OrthotropicConstants& constants, Analysis analysis) {
  const Eigen::MatrixXd s = compliance(constants, analysis) * constants.E1;
  constexpr double min_pivot = 1e-9;  // relative; nu = 0.5 in plane strain gives a pivot near 1e-17 of either sign
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(s);
  return constants.G12 > 0 && ldlt.vectorD().minCoeff() > min_pivot * ldlt.vectorD().maxCoeff();
}

Eigen::Matrix3d elasticity(const OrthotropicConstants& constants, double angle, Analysis analysis) {
  Eigen::Matrix3d D = Eigen::Matrix3d::Zero();
  D.topLeftCorner<2, 2>() = compliance(constants, analysis).inverse().topLeftCorner(2, 2);
  D(2, 2) = constants.G12;
  const Eigen::Matrix3d T = polar_stress(-angle);
  return T * D * T.transpose();
}

bool is_isotropic(const Eigen::Matrix3d& D) {
  constexpr double rounding = 1e-9;
  const double size = D.cwiseAbs().maxCoeff();
  const double off = std::max(
      {std::abs(D(0, 0) - D(1, 1)), std::abs(D(0, 2)), std::abs(D(1, 2)), std::abs(D(0, 0) - D(0, 1) - 2 * D(2, 2))});
  return off < rounding * size;
}

Eigen::Matrix3d polar_stress(double theta) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  Eigen::Matrix3d T;
  T << c * c, s * s, 2 * c * s,  //
      s * s, c * c, -2 * c * s,  //
      -c * s, c * s, c * c - s * s;
  return T;
}

}  // namespace fastjoint::pfem
