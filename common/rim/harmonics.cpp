// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/harmonics.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

namespace fastjoint::rim {
namespace {

/// A distribution as a cosine or sine of a multiple of an angle.
struct Wave {
  int multiple;
  bool is_sine;
  double amplitude;
};

Wave pressure_wave(const Harmonics& a, int k) {
  return {a.is_whole() ? (k + 1) / 2 : k, a.is_whole() && k > 0 && k % 2 == 0, k == 0 ? 1 : std::numbers::sqrt2};
}

Wave shear_wave(const Harmonics& a, int k) {
  return a.is_whole() ? pressure_wave(a, k) : Wave{k + 1, true, std::numbers::sqrt2};
}

/// Phase of the wave of multiple 1 per radian along the rim.
double phase_rate(const Harmonics& a) { return a.is_whole() ? 1 : std::numbers::pi / a.sweep; }

/// Highest multiple of any distribution.
int max_multiple(const Harmonics& a) { return a.is_whole() ? a.highest : a.size() - 1; }

constexpr double mean_of_wave = 1 / std::numbers::sqrt2;  ///< mean of sqrt(2) cos^2

bool is_half(const Harmonics& a) { return std::abs(a.sweep - std::numbers::pi) < 1e-7; }

/// Waves of a part of the circle as coefficients of the whole circle's basis, (2 highest + 1, n).
template <class WaveOf>
Eigen::MatrixXd of_whole(const Harmonics& a, int n, WaveOf wave_of) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(2 * a.highest + 1, n);
  for (int k = 0; k < n; ++k) {
    const Wave wave = wave_of(a, k);
    const int order = static_cast<int>(std::lround(wave.multiple * phase_rate(a)));
    const double phase = order * a.start;
    if (order == 0)
      T(0, k) = 1;
    else if (wave.is_sine)
      T.col(k).segment<2>(2 * order - 1) << -std::sin(phase), std::cos(phase);
    else
      T.col(k).segment<2>(2 * order - 1) << std::cos(phase), std::sin(phase);
  }
  return T;
}

/// Cosines and sines of the multiples 0..highest of an angle by repeated rotation. Their errors are rounding times the
/// multiple.
class Multiples {
 public:
  Multiples(double phase, int highest) : turns_(highest + 1) {
    const std::complex<double> turn = std::polar(1.0, phase);
    turns_[0] = 1;
    for (int j = 1; j <= highest; ++j) turns_[j] = turns_[j - 1] * turn;
  }
  [[nodiscard]] double cosine(int multiple) const { return turns_[multiple].real(); }
  [[nodiscard]] double sine(int multiple) const { return turns_[multiple].imag(); }
  [[nodiscard]] double at(const Wave& wave) const {
    return wave.amplitude * (wave.is_sine ? sine(wave.multiple) : cosine(wave.multiple));
  }

 private:
  std::vector<std::complex<double>> turns_;
};

/// Values of n distributions at an angle.
template <class WaveOf>
Eigen::VectorXd values_at(const Harmonics& a, int n, WaveOf wave_of, double angle) {
  const Multiples all(phase_rate(a) * (angle - a.start), max_multiple(a));
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index k) { return all.at(wave_of(a, static_cast<int>(k))); });
}

/// One step of Horner's rule: adds to a complex number x + i y, then rotates it by the angle with cosine c and sine s.
void turn(double& x, double& y, double c, double s, double more_x, double more_y) {
  const double sum_x = x + more_x, sum_y = y + more_y;
  x = c * sum_x - s * sum_y;
  y = s * sum_x + c * sum_y;
}

/// Waves of one kind and one amplitude: multiples first, first + 1, ... at the indices place, place + stride, ... of
/// the basis.
struct WaveGroup {
  int first, count;
  bool are_sines;
  Eigen::Index place, stride;
  [[nodiscard]] double amplitude() const { return first == 0 ? 1 : std::numbers::sqrt2; }
};

/// All waves of pressure, or of shear.
std::vector<WaveGroup> waves_of(const Harmonics& a, bool of_shear) {
  if (a.is_whole()) return {{0, 1, false, 0, 1}, {1, a.highest, false, 1, 2}, {1, a.highest, true, 2, 2}};
  if (of_shear) return {{1, a.n_shears(), true, 0, 1}};
  return {{0, 1, false, 0, 1}, {1, a.size() - 1, false, 1, 1}};
}

/// Integrals of cos(j phase) and of sin(j phase), j = -n..n at index n + j, summed over pieces of a rim.
struct IntegralsOfMultiples {
  Eigen::ArrayXd cosines, sines;
  IntegralsOfMultiples(const Harmonics& a, std::span<const SignedRange> pieces, int n)
      : cosines(Eigen::ArrayXd::Zero(2 * n + 1)), sines(Eigen::ArrayXd::Zero(2 * n + 1)) {
    for (const auto& piece : pieces) {
      const double from = phase_rate(a) * (piece.from - a.start), to = phase_rate(a) * (piece.to - a.start);
      const Multiples half_width((to - from) / 2, n), middle((from + to) / 2, n);
      cosines[n] += piece.sign * (to - from);
      for (int j = 1; j <= n; ++j) {
        const double width = piece.sign * 2.0 / j * half_width.sine(j);
        cosines[n + j] += width * middle.cosine(j);
        sines[n + j] += width * middle.sine(j);
      }
    }
    cosines.head(n) = cosines.tail(n).reverse();
    sines.head(n) = -sines.tail(n).reverse();
  }
};

/// Integrals over theta of the products of waves (pressures or shears, by pressures), summed over pieces of a rim.
Eigen::MatrixXd integrals(const Harmonics& a, bool of_shear, std::span<const SignedRange> pieces) {
  const int n = 2 * (max_multiple(a) + 1);
  const IntegralsOfMultiples of(a, pieces, n);
  Eigen::MatrixXd result(of_shear ? a.n_shears() : a.size(), a.size());
  for (const auto& columns : waves_of(a, false))
    for (int i = 0; i < columns.count; ++i)
      for (const auto& rows : waves_of(a, of_shear)) {
        const int column = columns.first + i;
        const double scale = columns.amplitude() * rows.amplitude() / 2 / phase_rate(a);
        const Eigen::ArrayXd& kind = rows.are_sines == columns.are_sines ? of.cosines : of.sines;
        const auto difference = kind.segment(n + rows.first - column, rows.count);
        const auto sum = kind.segment(n + rows.first + column, rows.count);
        Eigen::Map<Eigen::ArrayXd, 0, Eigen::InnerStride<>> out(&result(rows.place, columns.place + i * columns.stride),
                                                                rows.count, Eigen::InnerStride<>(rows.stride));
        if (!rows.are_sines && columns.are_sines)
          out = scale * (sum - difference);
        else
          out = scale * (difference + (columns.are_sines ? -1 : 1) * sum);
      }
  return result;
}

}  // namespace

int Harmonics::size() const {
  constexpr double rounding = 1e-9;
  return is_whole() ? 2 * highest + 1 : 1 + static_cast<int>(highest * sweep / std::numbers::pi + rounding);
}

bool Harmonics::repeats() const {
  const double parts = full_turn / sweep;
  constexpr double same = 1e-6;
  return std::abs(parts - 1) < same || std::abs(parts - 2) < same || std::abs(parts - 4) < same;
}

Eigen::MatrixXd Harmonics::pressures_of_whole() const {
  return is_whole() ? Eigen::MatrixXd::Identity(size(), size()) : of_whole(*this, size(), pressure_wave);
}

Eigen::MatrixXd Harmonics::shears_of_whole() const {
  return is_whole() ? Eigen::MatrixXd::Identity(size(), size()) : of_whole(*this, n_shears(), shear_wave);
}

Eigen::VectorXd Harmonics::at(double angle) const { return values_at(*this, size(), pressure_wave, angle); }

std::pair<double, double> Harmonics::sum_at(const Eigen::VectorXd& coefficients, double angle) const {
  const double phase = phase_rate(*this) * (angle - start);
  const double c = std::cos(phase), s = std::sin(phase);
  double re = 0, im = 0, slope_re = 0, slope_im = 0;  // sum of z_j e^(i j phase) and its slope by Horner's rule
  for (int j = max_multiple(*this); j >= 1; --j) {
    const Eigen::Index at = is_whole() ? 2 * Eigen::Index(j) - 1 : j;
    const double cosine = coefficients[at], sine = is_whole() ? coefficients[at + 1] : 0;
    turn(re, im, c, s, cosine, -sine);
    turn(slope_re, slope_im, c, s, j * cosine, -j * sine);
  }
  return {coefficients[0] + std::numbers::sqrt2 * re, -std::numbers::sqrt2 * phase_rate(*this) * slope_im};
}

double Harmonics::shear_sum_at(const Eigen::VectorXd& coefficients, double angle) const {
  if (is_whole()) return sum_at(coefficients, angle).first;
  const double phase = phase_rate(*this) * (angle - start);
  const double c = std::cos(phase), s = std::sin(phase);
  double re = 0, im = 0;
  for (Eigen::Index j = coefficients.size(); j >= 1; --j) turn(re, im, c, s, 0, -coefficients[j - 1]);
  return std::numbers::sqrt2 * re;
}

Eigen::VectorXd Harmonics::shears_at(double angle) const { return values_at(*this, n_shears(), shear_wave, angle); }

Eigen::VectorXd Harmonics::push(int axis) const {
  Eigen::VectorXd means = Eigen::VectorXd::Zero(size());
  if (is_whole()) means[1 + axis] = mean_of_wave;
  if (is_half(*this)) means[1] = mean_of_wave * (axis == 0 ? std::cos(start) : std::sin(start));
  return means;
}

Eigen::VectorXd Harmonics::drag(int axis) const {
  Eigen::VectorXd means = Eigen::VectorXd::Zero(n_shears());
  if (is_whole()) means[2 - axis] = axis == 0 ? -mean_of_wave : mean_of_wave;
  if (is_half(*this)) means[0] = -mean_of_wave * (axis == 0 ? std::cos(start) : std::sin(start));
  return means;
}

Eigen::MatrixXd Harmonics::products(std::span<const SignedRange> pieces) const {
  return integrals(*this, false, pieces);
}

Eigen::MatrixXd Harmonics::shear_products(std::span<const SignedRange> pieces) const {
  return integrals(*this, true, pieces);
}

std::vector<std::string> friction_cases(std::span<const Axis> directions) {
  std::vector<std::string> names;
  for (const Axis axis : directions)
    for (const int sign : {1, -1}) names.push_back(name_of(SignedAxis{axis, sign}));
  return names;
}

}  // namespace fastjoint::rim
