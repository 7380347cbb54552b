// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/harmonics.hpp"

#include <cmath>
#include <complex>
#include <numbers>
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

/// The angle of which a wave is a multiple, per radian along the rim.
double unit(const Harmonics& a) { return a.is_whole() ? 1 : std::numbers::pi / a.sweep; }

/// Highest multiple of any distribution.
int most(const Harmonics& a) { return a.is_whole() ? a.highest : a.size() - 1; }

constexpr double mean_of_wave = 1 / std::numbers::sqrt2;  ///< mean of sqrt(2) cos^2

bool is_half(const Harmonics& a) { return std::abs(a.sweep - std::numbers::pi) < 1e-7; }

/// Columns of the whole circle's distributions, (2 highest + 1, n), for the waves of a part of it.
template <class WaveOf>
Eigen::MatrixXd of_whole(const Harmonics& a, int n, WaveOf wave_of) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(2 * a.highest + 1, n);
  for (int k = 0; k < n; ++k) {
    const Wave wave = wave_of(a, k);
    const int order = static_cast<int>(std::lround(wave.multiple * unit(a)));
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

/// cos and sin of the multiples 0..highest of an angle, by turns: their errors are rounding times the multiple.
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

/// Integrals of the products of waves between two angles, (rows, columns).
Eigen::MatrixXd integrals(const std::vector<Wave>& rows, const std::vector<Wave>& columns, double unit, double a,
                          double b) {
  const int most = rows.back().multiple + columns.back().multiple;
  // Integrals of cos(j phase) and sin(j phase), j = -most..most.
  Eigen::VectorXd cosines(2 * most + 1), sines(2 * most + 1);
  double *cosine = cosines.data() + most, *sine = sines.data() + most;
  cosine[0] = b - a, sine[0] = 0;
  const Multiples half_width((b - a) / 2, most), middle((a + b) / 2, most);
  for (int j = 1; j <= most; ++j) {
    const double width = 2.0 / j * half_width.sine(j);
    cosine[j] = cosine[-j] = width * middle.cosine(j);
    sine[j] = width * middle.sine(j);
    sine[-j] = -sine[j];
  }
  Eigen::MatrixXd result(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index l = 0; l < result.cols(); ++l) {
    const Wave& column = columns[l];
    const double scale = column.amplitude / 2 / unit, sign = column.is_sine ? -1 : 1;
    for (Eigen::Index k = 0; k < result.rows(); ++k) {
      const Wave& row = rows[k];
      const int sum = row.multiple + column.multiple, difference = row.multiple - column.multiple;
      result(k, l) = scale * row.amplitude *
                     (row.is_sine == column.is_sine ? cosine[difference] + sign * cosine[sum]
                                                    : sine[sum] + sign * sine[difference]);
    }
  }
  return result;
}

template <class WaveOf>
std::vector<Wave> waves(const Harmonics& a, int n, WaveOf wave_of) {
  std::vector<Wave> list;
  for (int k = 0; k < n; ++k) list.push_back(wave_of(a, k));
  return list;
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

Eigen::VectorXd Harmonics::at(double angle) const {
  const Multiples all(unit(*this) * (angle - start), most(*this));
  return Eigen::VectorXd::NullaryExpr(
      size(), [&](Eigen::Index k) { return all.at(pressure_wave(*this, static_cast<int>(k))); });
}

std::pair<double, double> Harmonics::sum_at(const Eigen::VectorXd& amounts, double angle) const {
  const double phase = unit(*this) * (angle - start);
  const double c = std::cos(phase), s = std::sin(phase);
  double re = 0, im = 0, slope_re = 0, slope_im = 0;  // of sum z_j e^(i j phase), by Horner's rule
  for (int j = most(*this); j >= 1; --j) {
    const Eigen::Index at = is_whole() ? 2 * Eigen::Index(j) - 1 : j;
    const double cosine = amounts[at], sine = is_whole() ? amounts[at + 1] : 0;
    const auto turned = [&](double& x, double& y, double more_x, double more_y) {
      const double sum_x = x + more_x, sum_y = y + more_y;
      x = c * sum_x - s * sum_y;
      y = s * sum_x + c * sum_y;
    };
    turned(re, im, cosine, -sine);
    turned(slope_re, slope_im, j * cosine, -j * sine);
  }
  return {amounts[0] + std::numbers::sqrt2 * re, -std::numbers::sqrt2 * unit(*this) * slope_im};
}

Eigen::VectorXd Harmonics::shears_at(double angle) const {
  const Multiples all(unit(*this) * (angle - start), most(*this));
  return Eigen::VectorXd::NullaryExpr(n_shears(),
                                      [&](Eigen::Index k) { return all.at(shear_wave(*this, static_cast<int>(k))); });
}

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

Eigen::MatrixXd Harmonics::products(double from, double to) const {
  const auto all = waves(*this, size(), pressure_wave);
  return integrals(all, all, unit(*this), unit(*this) * (from - start), unit(*this) * (to - start));
}

Eigen::MatrixXd Harmonics::shear_products(double from, double to) const {
  return integrals(waves(*this, n_shears(), shear_wave), waves(*this, size(), pressure_wave), unit(*this),
                   unit(*this) * (from - start), unit(*this) * (to - start));
}

std::vector<std::string> friction_cases(std::span<const std::string> directions) {
  std::vector<std::string> names;
  for (const auto& direction : directions)
    for (const char* sign : {"+", "-"}) names.push_back(sign + direction);
  return names;
}

}  // namespace fastjoint::rim
