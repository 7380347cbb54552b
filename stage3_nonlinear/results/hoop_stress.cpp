// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hoop_stress.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

namespace fastjoint::stage3 {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using namespace std::complex_literals;
constexpr double angle_step = rim::full_turn / TractionWaves::n_points,
                 first_angle = angle_step / 2;  // off the multiples of 90 degrees, at which tractions jump

/// (cos, sin) of the angles of the points, (2, n_points).
const Eigen::Matrix2Xd& normals() {
  static const Eigen::Matrix2Xd all = [] {
    Eigen::Matrix2Xd result(2, TractionWaves::n_points);
    for (int i = 0; i < TractionWaves::n_points; ++i)
      result.col(i) << std::cos(first_angle + i * angle_step), std::sin(first_angle + i * angle_step);
    return result;
  }();
  return all;
}

/// e^(i m first_angle), m = 0.., (n_points / 2).
const Eigen::VectorXcd& turns() {
  static const Eigen::VectorXcd all = Eigen::VectorXcd::NullaryExpr(
      TractionWaves::n_points / 2, [](Index m) { return std::polar(1.0, double(m) * first_angle); });
  return all;
}

/// Waves m = 0..n/2-1 of two real functions from their values at the points, (2, n / 2).
Eigen::Matrix2Xcd waves_of(const Eigen::VectorXcd& values) {
  Eigen::FFT<double> fft;
  Eigen::VectorXcd F;
  fft.fwd(F, values);
  const Index n = values.size();
  Eigen::Matrix2Xcd waves(2, n / 2);
  for (Index m = 0; m < n / 2; ++m) {
    const Complex plus = F[m], minus = std::conj(F[(n - m) % n]), turn = turns()[m] / double(n);
    waves(0, m) = std::conj((plus + minus) / 2.0) * turn;
    waves(1, m) = std::conj((plus - minus) / 2.0i) * turn;
  }
  return waves;
}

/// Imaginary parts of the sums over m >= first of the waves at all points, (2, n).
Eigen::Matrix2Xd imaginary_sums(const Eigen::Matrix2Xcd& waves, Index first) {
  Eigen::FFT<double> fft;
  const Index n = 2 * waves.cols();
  Eigen::VectorXcd f = Eigen::VectorXcd::Zero(n), F;
  // One transform of complex numbers adds up both rows: a number less its conjugate is twice its imaginary part.
  for (Index m = std::max<Index>(first, 1); m < n / 2; ++m) {
    const Complex x = waves(0, m) * std::conj(turns()[m]), y = waves(1, m) * std::conj(turns()[m]);
    f[m] = (x + 1i * y) / 2.0;
    f[n - m] = -(std::conj(x) + 1i * std::conj(y)) / 2.0;
  }
  fft.fwd(F, f);
  Eigen::Matrix2Xd result(2, n);
  result << F.imag().transpose(), -F.real().transpose();
  return result;
}

/// Imaginary part of the sum over m >= first of the waves at an angle, in four chains of rotations.
Eigen::Vector2d imaginary_sum(const Eigen::Matrix2Xcd& waves, Index first, double angle) {
  using Eigen::Array4d;
  constexpr Index chains = 4;
  const Array4d phase = angle * (double(first) + Array4d(0, 1, 2, 3));
  Array4d c = phase.cos(), s = phase.sin(), x = Array4d::Zero(), y = Array4d::Zero();
  const double turn_c = std::cos(double(chains) * angle), turn_s = std::sin(double(chains) * angle);
  Index m = first;
  for (; m + chains <= waves.cols(); m += chains) {
    for (Index j = 0; j < chains; ++j) {
      const Complex &a = waves(0, m + j), &b = waves(1, m + j);
      x[j] += a.imag() * c[j] - a.real() * s[j];
      y[j] += b.imag() * c[j] - b.real() * s[j];
    }
    const Array4d before = c;
    c = turn_c * c - turn_s * s;
    s = turn_s * before + turn_c * s;
  }
  Eigen::Vector2d sum(x.sum(), y.sum());
  for (; m < waves.cols(); ++m) sum += (waves.col(m) * std::polar(1.0, -double(m) * angle)).imag();
  return sum;
}

/// Waves m = 0.. of a function from its coefficients of the distributions on the whole circle.
Eigen::VectorXcd complex_waves(const Eigen::VectorXd& coefficients) {
  const Index highest = coefficients.size() / 2;
  Eigen::VectorXcd f(highest + 1);
  f[0] = coefficients[0];
  for (Index m = 1; m <= highest; ++m)
    f[m] = Complex(coefficients[2 * m - 1], coefficients[2 * m]) / std::numbers::sqrt2;
  return f;
}

/// Waves 0..n-1 along x and y from normal and tangential waves 0..n.
Eigen::Matrix2Xcd cartesian(const Eigen::VectorXcd& normal, const Eigen::VectorXcd& tangential) {
  const Index n = normal.size() - 1;
  Eigen::Matrix2Xcd u(2, n);
  for (Index m = 0; m < n; ++m) {
    const auto before = [&](const Eigen::VectorXcd& f) { return m > 0 ? f[m - 1] : std::conj(f[1]); };
    const auto times = [&](const Eigen::VectorXcd& f) {  // cosine and sine
      return std::pair((f[m + 1] + before(f)) / 2.0, (f[m + 1] - before(f)) / 2.0i);
    };
    const auto [n_cos, n_sin] = times(normal);
    const auto [t_cos, t_sin] = times(tangential);
    u.col(m) << n_cos - t_sin, n_sin + t_cos;
  }
  return u;
}

}  // namespace

TractionWaves::TractionWaves(const rim::Harmonics& rim, Tractions tractions)
    : rim_(rim), tractions_(std::move(tractions)), values_(2, n_points) {
  for (int i = 0; i < n_points; ++i) values_.col(i) = at(first_angle + i * angle_step);
  waves_ = waves_of(values_.row(0).cast<Complex>() + 1i * values_.row(1).cast<Complex>());
}

Eigen::VectorXd TractionWaves::angles() {
  return Eigen::VectorXd::LinSpaced(n_points, first_angle, first_angle + (n_points - 1) * angle_step);
}

Eigen::Vector2d TractionWaves::at(double angle) const {
  double modelled = rim::wrapped(angle, rim_.start), sign = 1;
  if (!rim_.is_whole()) {
    const double past = modelled - rim_.start;
    const int part = static_cast<int>(past / rim_.sweep);
    const double rest = past - part * rim_.sweep;
    if (part % 2 == 1) sign = -1;
    modelled = rim_.start + (sign > 0 ? rest : rim_.sweep - rest);
  }
  const Eigen::Vector2d on_rim = tractions_(modelled);
  const double p = on_rim.x(), t = sign * on_rim.y(), c = std::cos(angle), s = std::sin(angle);
  return {p * c - t * s, p * s + t * c};
}

HoopStress::HoopStress(const rim::RimCompliance& sheet, const rim::Harmonics& waves,
                       const Eigen::VectorXd& displacement, std::shared_ptr<const TractionWaves> tractions)
    : sheet_(sheet),
      tractions_(std::move(tractions)),
      first_short_(waves.highest),
      u_(cartesian(complex_waves(-waves.pressures_of_whole() * displacement.head(waves.size())),
                   complex_waves(-waves.shears_of_whole() * displacement.tail(waves.n_shears())))),
      angles_(TractionWaves::angles()),
      values_(angles_.size()) {
  const Eigen::Matrix2Xd &traction = tractions_->values(), &normal = normals();
  const Eigen::Matrix2Xd imaginary = imaginary_sums(tractions_->waves(), first_short_);
  for (Index i = 0; i < values_.size(); ++i)
    values_[i] =
        hoop(angles_[i], normal.col(i), strain(normal.col(i), imaginary.col(i), traction.col(i)), traction.col(i));
}

double HoopStress::strain(const Eigen::Vector2d& normal, const Eigen::Vector2d& imaginary,
                          const Eigen::Vector2d& traction) const {
  // The real part of the short waves is the traction minus its long waves; only the imaginary part needs the sum.
  const Complex turn(normal.x(), -normal.y());
  const Eigen::Matrix2Xcd& T = tractions_->waves();
  Eigen::Vector2d rest = traction - T.col(0).real();
  Eigen::Vector2cd slope = Eigen::Vector2cd::Zero();
  Complex at = turn;
  for (int m = 1; m < first_short_; ++m, at *= turn) {
    rest -= 2 * (T.col(m) * at).real();
    slope -= double(m) * 1.0i * at * u_.col(m);
  }
  const Eigen::Vector2cd exact = rest / 2 + 1i * imaginary;
  slope = (slope / sheet_.radius() + sheet_.slope() * exact).eval();
  return 2 * (normal.x() * slope[1].real() - normal.y() * slope[0].real());
}

double HoopStress::hoop(double angle, const Eigen::Vector2d& normal, double strain,
                        const Eigen::Vector2d& traction) const {
  const double c = normal.x(), s = normal.y();
  const double p = c * traction.x() + s * traction.y(), t = c * traction.y() - s * traction.x();
  const Eigen::Vector3d by = sheet_.along(angle);
  return (strain + by[0] * p + by[2] * t) / by[1];
}

double HoopStress::at(double angle) const {
  const Eigen::Vector2d traction = tractions_->at(angle), normal(std::cos(angle), std::sin(angle));
  return hoop(angle, normal, strain(normal, imaginary_sum(tractions_->waves(), first_short_, angle), traction),
              traction);
}

Eigen::VectorXd HoopStress::change_by_tractions(int first, int end) const {
  const Eigen::Matrix2Xd& normal = normals();
  Eigen::Matrix2Xcd slopes(2, end - first);  // change of (du_x/dtheta, du_y/dtheta) over the radius
  for (int m = first; m < end; ++m)
    slopes.col(m - first) =
        sheet_.slope() * tractions_->waves().col(m) + double(m) * 1.0i * u_.col(m) / sheet_.radius();
  return Eigen::VectorXd::NullaryExpr(normal.cols(), [&](Index i) {
    const Complex turn(normal(0, i), -normal(1, i));
    Complex at = std::pow(turn, first);
    Eigen::Vector2d sum(0, 0);
    for (Index k = 0; k < slopes.cols(); ++k, at *= turn) sum += (slopes.col(k) * at).real();
    return 2 * (normal(0, i) * sum.y() - normal(1, i) * sum.x()) / sheet_.along(angles_[i])[1];
  });
}

}  // namespace fastjoint::stage3
