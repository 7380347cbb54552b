// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/near_stress.hpp"

#include <Eigen/LU>
#include <cmath>
#include <complex>

namespace fastjoint::stage3 {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using namespace std::complex_literals;

/// The compliance, or in a sheet with equal roots, such as an isotropic one, one whose shear compliance is larger by
/// 1e-9 of 1/E: its roots differ by 3e-5, so that its potentials are independent, and its stresses differ by about
/// 1e-9.
Eigen::Matrix3d with_distinct_roots(const rim::RimCompliance& sheet) {
  Eigen::Matrix3d a = sheet.compliance();
  constexpr double equal = 1e-5, little = 1e-9;
  if (std::abs(sheet.roots()[0] - sheet.roots()[1]) < equal * std::abs(sheet.roots()[0])) a(2, 2) += little * a(0, 0);
  return a;
}

/// The root of zeta's quadratic equation outside the unit circle (docs/theory.md, section 11.3). @param z Place over
/// the radius, x + mu y.
Complex zeta_of(Complex z, Complex mu) {
  const Complex root = std::sqrt(z * z - 1.0 - mu * mu), plus = z + root, minus = z - root;
  return (std::norm(plus) > std::norm(minus) ? plus : minus) / (1.0 - 1i * mu);
}

}  // namespace

NearStress::NearStress(const HoopStress& rim, double distance) : radius_(rim.sheet().radius()), distance_(distance) {
  const Eigen::Matrix3d a = with_distinct_roots(rim.sheet());
  const Eigen::Vector2cd mu = rim::RimCompliance(a, radius_).roots();
  roots_ = {mu[0], mu[1]};
  // Rows: du_x/dtheta, du_y/dtheta, minus the radius times the traction along x, and it times that along y. Columns:
  // the derivatives of the potentials by theta and their conjugates.
  Eigen::Matrix4cd M;
  for (const int k : {0, 1}) {
    M.col(k) << a(0, 0) * mu[k] * mu[k] + a(0, 1) - a(0, 2) * mu[k], a(0, 1) * mu[k] + a(1, 1) / mu[k] - a(1, 2), mu[k],
        1.0;
    M.col(k + 2) = M.col(k).conjugate();
  }
  const Eigen::Matrix4cd inverse = M.inverse();
  const Eigen::Matrix2cd infinite = M.block<2, 2>(2, 0).inverse();
  const Eigen::Matrix2Xcd &u = rim.displacement_waves(), &T = rim.tractions().waves();
  growing_.resize(2, u.cols());
  decaying_.resize(2, T.cols());
  for (Index m = 0; m < T.cols(); ++m) {
    const Eigen::Vector2cd force(-radius_ * T(0, m), radius_ * T(1, m));
    if (m >= u.cols()) {
      decaying_.col(m) = infinite * force;
      continue;
    }
    Eigen::Vector4cd wave;
    wave << -1i * double(m) * u.col(m), force;
    decaying_.col(m) = inverse.topRows<2>() * wave;
    growing_.col(m) = inverse.topRows<2>() * wave.conjugate();
  }
  decaying_.col(0).setZero();  // the mean is in the other sum
}

Eigen::Vector3d NearStress::at(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle), r = 1 + distance_ / radius_;
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();  // x, y, xy
  for (const int k : {0, 1}) {
    const Complex mu = roots_[k], zeta = zeta_of(r * (c + mu * s), mu), inward = 1.0 / zeta;
    Complex sum = 0;
    for (Index m = growing_.cols() - 1; m >= 0; --m) sum = sum * zeta + growing_(k, m);
    constexpr double negligible = 1e-18;
    Complex power = inward;
    for (Index m = 1; m < decaying_.cols() && std::norm(power) > negligible * negligible; ++m, power *= inward)
      sum += decaying_(k, m) * power;
    const Complex slope = sum / (0.5i * radius_ * ((1.0 - 1i * mu) * zeta - (1.0 + 1i * mu) * inward));
    stress += 2 * Eigen::Vector3d((mu * mu * slope).real(), slope.real(), -(mu * slope).real());
  }
  const double xx = stress[0], yy = stress[1], xy = stress[2];
  return {c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy,
          c * s * (yy - xx) + (c * c - s * s) * xy};
}

}  // namespace fastjoint::stage3
