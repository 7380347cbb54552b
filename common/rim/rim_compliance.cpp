// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/rim_compliance.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::rim {
namespace {

using Complex = std::complex<double>;
using namespace std::complex_literals;

/// The two roots with positive imaginary part of Lekhnitskii's equation
/// a11 mu^4 - 2 a16 mu^3 + (2 a12 + a66) mu^2 - 2 a26 mu + a22 = 0. Their sum and product are exact to rounding even
/// for equal roots.
Eigen::Vector2cd roots_of(const Eigen::Matrix3d& a) {
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  companion.diagonal(-1).setOnes();
  companion.row(0) << 2 * a(0, 2), -(2 * a(0, 1) + a(2, 2)), 2 * a(1, 2), -a(1, 1);
  companion.row(0) /= a(0, 0);
  Eigen::Vector2cd roots(1i, 1i);
  int found = 0;
  for (const auto& root : matrices::eigenvalues(companion))
    if (root.imag() > 0 && found < 2) roots[found++] = root;
  return roots;
}

/// Coefficients f_m, m = 1..n at index m - 1, of a distribution of the whole circle as 2 Re sum f_m e^(-i m theta).
Eigen::VectorXcd wave(int k, int n) {
  Eigen::VectorXcd f = Eigen::VectorXcd::Zero(n);
  if (const int order = (k + 1) / 2; order > 0) f[order - 1] = (k % 2 == 1 ? Complex(1) : 1i) / std::numbers::sqrt2;
  return f;
}

/// Coefficients of the whole circle's basis up to `highest`, without the mean.
Eigen::VectorXd coefficients(const Eigen::VectorXcd& f, int highest) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(2 * highest + 1);
  for (int m = 1; m <= highest; ++m) result.segment<2>(2 * m - 1) << f[m - 1].real(), f[m - 1].imag();
  return std::numbers::sqrt2 * result;
}

/// Coefficients of f cos theta and of f sin theta for those of an f without mean.
struct Turned {
  Eigen::VectorXcd cosine, sine;
};
Turned turned(const Eigen::VectorXcd& f) {
  const auto n = f.size();
  Turned result{Eigen::VectorXcd::Zero(n), Eigen::VectorXcd::Zero(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i > 0) result.cosine[i - 1] += f[i] / 2.0, result.sine[i - 1] += f[i] / 2.0i;
    if (i + 1 < n) result.cosine[i + 1] += f[i] / 2.0, result.sine[i + 1] -= f[i] / 2.0i;
  }
  return result;
}

}  // namespace

RimCompliance::RimCompliance(const Eigen::Matrix3d& compliance, double radius)
    : compliance_(compliance), radius_(radius), roots_(roots_of(compliance)) {
  const Complex s = roots_.sum(), r = roots_.prod();
  const double a11 = compliance(0, 0), a12 = compliance(0, 1), a22 = compliance(1, 1);
  slope_ << compliance(0, 2) - a11 * s, a12 - a11 * r,  //
      a22 / r - a12, a22 * s / r - compliance(1, 2);
}

double RimCompliance::fall(const Eigen::Vector2d& place) const {
  double largest = 0;
  for (const Complex& mu : roots_) {
    const Complex z = (place.x() + mu * place.y()) / radius_, root = std::sqrt(z * z - 1.0 - mu * mu);
    const double zeta = std::max(std::abs((z + root) / (1.0 - 1i * mu)), std::abs((z - root) / (1.0 - 1i * mu)));
    largest = std::max(largest, 1 / std::max(zeta, 1.0));
  }
  return largest;
}

Eigen::Vector3d RimCompliance::along(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::RowVector3d strain(s * s, c * c, -c * s);  // from (x, y, xy)
  Eigen::Matrix3d stress;                                 // (x, y, xy) from (rr, tt, rt)
  stress << c * c, s * s, -2 * c * s,                     //
      s * s, c * c, 2 * c * s,                            //
      c * s, -c * s, c * c - s * s;
  return (strain * compliance_ * stress).transpose();
}

Eigen::MatrixXd RimCompliance::displacements(const Harmonics& waves) const {
  const int highest = waves.highest, n = 2 * highest + 1;
  constexpr int wider = 2;  // rotation to x and y and back raises the order by one each
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(Eigen::Index{2} * n, Eigen::Index{2} * n);
  for (const bool is_shear : {false, true})
    for (int k = 3; k < n; ++k) {
      const auto [cosine, sine] = turned(wave(k, highest + wider));
      const Eigen::VectorXcd X = is_shear ? Eigen::VectorXcd(-sine) : cosine, Y = is_shear ? cosine : sine;
      Eigen::VectorXcd u_x(X.size()), u_y(X.size());
      for (Eigen::Index i = 0; i < X.size(); ++i) {
        const Eigen::Vector2cd u = 1i * radius_ / double(i + 1) * (slope_ * Eigen::Vector2cd(X[i], Y[i]));
        u_x[i] = u.x();
        u_y[i] = u.y();
      }
      const Turned x = turned(u_x), y = turned(u_y);
      all.col(k + (is_shear ? n : 0)) << coefficients(x.cosine + y.sine, highest),
          coefficients(y.cosine - x.sine, highest);
    }
  for (const int block : {0, n}) all.middleRows(block, 3).setZero();
  const Eigen::MatrixXd p = waves.pressures_of_whole(), t = waves.shears_of_whole();
  Eigen::MatrixXd result(p.cols() + t.cols(), p.cols() + t.cols());
  result << p.transpose() * all.topLeftCorner(n, n) * p, p.transpose() * all.topRightCorner(n, n) * t,
      t.transpose() * all.bottomLeftCorner(n, n) * p, t.transpose() * all.bottomRightCorner(n, n) * t;
  return (0.5 * (result + result.transpose())).eval();
}

}  // namespace fastjoint::rim
