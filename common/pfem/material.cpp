// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/material.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::pfem {
namespace {

/// Compliance between the normal stresses and strains along the material axes of those that the analysis knows.
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
  constexpr double least_pivot = 1e-9;  // nu = 0.5 in plane strain rounds to a pivot near 1e-17 of either sign
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(s);
  return constants.G12 > 0 && ldlt.vectorD().minCoeff() > least_pivot * ldlt.vectorD().maxCoeff();
}

Eigen::Matrix3d elasticity(const OrthotropicConstants& constants, double angle, Analysis analysis) {
  Eigen::Matrix3d D = Eigen::Matrix3d::Zero();
  D.topLeftCorner<2, 2>() = compliance(constants, analysis).inverse().topLeftCorner(2, 2);
  D(2, 2) = constants.G12;
  const Eigen::Matrix3d T = polar_stress(-angle);
  return T * D * T.transpose();
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

double hoop_by_pressure(const Eigen::Matrix3d& compliance, double theta) {
  const Eigen::Matrix3d to_global = polar_stress(-theta);
  const Eigen::Matrix3d s = to_global.transpose() * compliance * to_global;  // axes r, t
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  companion.diagonal(-1).setOnes();
  companion.row(0) << 2 * s(1, 2), -(2 * s(0, 1) + s(2, 2)), 2 * s(0, 2), -s(0, 0);
  companion.row(0) /= s(1, 1);
  const Eigen::VectorXcd roots = matrices::eigenvalues(companion);
  std::complex<double> product = -1;
  for (const auto& root : roots)
    if (root.imag() > 0) product *= root;
  return product.real();
}

}  // namespace fastjoint::pfem
