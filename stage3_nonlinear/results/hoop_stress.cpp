// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hoop_stress.hpp"

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

/// Waves m = 0..n/2-1 of two real functions from their values at the points, (2, n / 2).
Eigen::Matrix2Xcd waves_of(const Eigen::VectorXcd& values) {
  Eigen::FFT<double> fft;
  Eigen::VectorXcd F;
  fft.fwd(F, values);
  const Index n = values.size();
  Eigen::Matrix2Xcd waves(2, n / 2);
  for (Index m = 0; m < n / 2; ++m) {
    const Complex plus = F[m], minus = std::conj(F[(n - m) % n]),
                  turn = std::polar(1.0 / double(n), double(m) * first_angle);
    waves(0, m) = std::conj((plus + minus) / 2.0) * turn;
    waves(1, m) = std::conj((plus - minus) / 2.0i) * turn;
  }
  return waves;
}

/// Sums over m >= first of the waves at all points, (2, n).
Eigen::Matrix2Xcd sums(const Eigen::Matrix2Xcd& waves, Index first) {
  Eigen::FFT<double> fft;
  const Index n = 2 * waves.cols();
  Eigen::Matrix2Xcd result(2, n);
  for (const int row : {0, 1}) {
    Eigen::VectorXcd f = Eigen::VectorXcd::Zero(n), F;
    for (Index m = first; m < n / 2; ++m) f[m] = waves(row, m) * std::polar(1.0, -double(m) * first_angle);
    fft.fwd(F, f);
    result.row(row) = F.transpose();
  }
  return result;
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
  const Eigen::Matrix2Xd& traction = tractions_->values();
  const Eigen::Matrix2Xcd short_waves = sums(tractions_->waves(), first_short_);
  for (Index i = 0; i < values_.size(); ++i)
    values_[i] = hoop(angles_[i], strain(angles_[i], short_waves.col(i), traction.col(i)), traction.col(i));
}

double HoopStress::strain(double angle, const Eigen::Vector2cd& short_waves, const Eigen::Vector2d& traction) const {
  // The real part of the short waves is the traction minus its long waves; only the imaginary part needs the sum.
  const Complex turn = std::polar(1.0, -angle);
  const Eigen::Matrix2Xcd& T = tractions_->waves();
  Eigen::Vector2d rest = traction - T.col(0).real();
  Eigen::Vector2cd slope = Eigen::Vector2cd::Zero();
  Complex at = turn;
  for (int m = 1; m < first_short_; ++m, at *= turn) {
    rest -= 2 * (T.col(m) * at).real();
    slope -= double(m) * 1.0i * at * u_.col(m);
  }
  Eigen::Vector2cd exact;
  for (const int i : {0, 1}) exact[i] = Complex(rest[i] / 2, short_waves[i].imag());
  slope = (slope / sheet_.radius() + sheet_.slope() * exact).eval();
  return 2 * (-std::sin(angle) * slope[0].real() + std::cos(angle) * slope[1].real());
}

double HoopStress::hoop(double angle, double strain, const Eigen::Vector2d& traction) const {
  const double c = std::cos(angle), s = std::sin(angle);
  const double p = c * traction.x() + s * traction.y(), t = c * traction.y() - s * traction.x();
  const Eigen::Vector3d by = sheet_.along(angle);
  return (strain + by[0] * p + by[2] * t) / by[1];
}

double HoopStress::at(double angle) const {
  Eigen::Vector2cd short_waves = Eigen::Vector2cd::Zero();
  const Complex turn = std::polar(1.0, -angle);
  Complex at = std::polar(1.0, -angle * first_short_);
  const Eigen::Matrix2Xcd& T = tractions_->waves();
  for (Index m = first_short_; m < T.cols(); ++m, at *= turn) short_waves += T.col(m) * at;
  const Eigen::Vector2d traction = tractions_->at(angle);
  return hoop(angle, strain(angle, short_waves, traction), traction);
}

}  // namespace fastjoint::stage3
