// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/harmonics.hpp"

#include <cmath>
#include <numbers>

namespace fastjoint::rim {
namespace {

/// A distribution as a cosine or sine of a multiple of an angle.
struct Wave {
  int multiple;
  bool is_sine;
  double amplitude;
};

Wave wave(const Harmonics& a, int k) {
  return {a.is_whole() ? (k + 1) / 2 : k, a.is_whole() && k > 0 && k % 2 == 0, k == 0 ? 1 : std::numbers::sqrt2};
}

/// The angle of which a wave is a multiple, per radian along the rim.
double unit(const Harmonics& a) { return a.is_whole() ? 1 : std::numbers::pi / a.sweep; }

}  // namespace

int Harmonics::size() const {
  constexpr double rounding = 1e-9;
  return is_whole() ? 2 * highest + 1 : 1 + static_cast<int>(highest * sweep / std::numbers::pi + rounding);
}

Eigen::VectorXd Harmonics::at(double angle) const {
  const double phase = unit(*this) * (angle - start);
  return Eigen::VectorXd::NullaryExpr(size(), [&](Eigen::Index k) {
    const auto [multiple, is_sine, amplitude] = wave(*this, static_cast<int>(k));
    return amplitude * (is_sine ? std::sin(multiple * phase) : std::cos(multiple * phase));
  });
}

Eigen::VectorXd Harmonics::slope(double angle) const {
  const double phase = unit(*this) * (angle - start);
  return Eigen::VectorXd::NullaryExpr(size(), [&](Eigen::Index k) {
    const auto [multiple, is_sine, amplitude] = wave(*this, static_cast<int>(k));
    return amplitude * multiple * unit(*this) * (is_sine ? std::cos(multiple * phase) : -std::sin(multiple * phase));
  });
}

Eigen::MatrixXd Harmonics::products(double from, double to) const {
  const double a = unit(*this) * (from - start), b = unit(*this) * (to - start);
  const int n = size(), most = 2 * wave(*this, n - 1).multiple;
  Eigen::VectorXd cosine(most + 1), sine(most + 1);  // integrals of cos(j phase) and sin(j phase)
  cosine[0] = b - a, sine[0] = 0;
  for (int j = 1; j <= most; ++j) {
    const double width = 2.0 / j * std::sin(j * (b - a) / 2);
    cosine[j] = width * std::cos(j * (a + b) / 2);
    sine[j] = width * std::sin(j * (a + b) / 2);
  }
  Eigen::MatrixXd result(n, n);
  for (int k = 0; k < n; ++k)
    for (int l = 0; l <= k; ++l) {
      const Wave high = wave(*this, k), low = wave(*this, l);
      const int sum = high.multiple + low.multiple, difference = high.multiple - low.multiple;
      double value = high.is_sine ? sine[sum] + sine[difference] : sine[sum] - sine[difference];
      if (high.is_sine == low.is_sine) value = cosine[difference] + (high.is_sine ? -1 : 1) * cosine[sum];
      result(k, l) = result(l, k) = high.amplitude * low.amplitude / 2 / unit(*this) * value;
    }
  return result;
}

}  // namespace fastjoint::rim
