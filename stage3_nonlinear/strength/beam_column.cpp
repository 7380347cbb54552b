// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/beam_column.hpp"

#include <algorithm>
#include <cmath>

namespace fastjoint::stage3 {

/// One formula serves tension and compression: r = sqrt(N L^2 / EI) is real or imaginary, and the entries are even in
/// it. In tension all terms are divided by exp(r), so that none overflows.
Eigen::Matrix4cd BeamColumn::at(std::complex<double> tension) const {
  using Number = std::complex<double>;
  constexpr double few = 1e-2;  // below this the series has 11 digits, above it the formula
  const double L = length;
  const Number z = tension * L * L / EI;
  Number k1, k2, k3, k4;
  if (std::abs(z) < few) {
    k1 = 12.0 + z * (6.0 / 5 - z * (1.0 / 700 - z / 63000.0));
    k2 = 6.0 + z * (1.0 / 10 - z * (1.0 / 1400 - z / 126000.0));
    k3 = 4.0 + z * (2.0 / 15 - z * (11.0 / 6300 - z / 27000.0));
    k4 = 2.0 - z * (1.0 / 30 - z * (13.0 / 12600 - 11.0 * z / 378000.0));
  } else {
    const Number r = std::sqrt(z);
    const double most = tension.real() > 0 ? r.real() : 0;
    const auto half = [&](Number power) { return std::exp(power - most) / 2.0; };
    const Number s = most > 0 ? half(r) - half(-r) : std::sinh(r);
    const Number c = most > 0 ? half(r) + half(-r) : std::cosh(r), one = std::exp(-most);
    const Number D = 2.0 * (one - c) + r * s;
    k1 = r * r * r * s / D, k2 = r * r * (c - one) / D, k3 = r * (r * c - s) / D, k4 = r * (s - r * one) / D;
  }
  Eigen::Matrix4cd K;
  K << k1, k2 * L, -k1, k2 * L,                 //
      k2 * L, k3 * L * L, -k2 * L, k4 * L * L,  //
      -k1, -k2 * L, k1, -k2 * L,                //
      k2 * L, k4 * L * L, -k2 * L, k3 * L * L;
  return EI / (L * L * L) * K;
}

/// The complex step of the derivative makes it exact to rounding.
Eigen::Matrix4d BeamColumn::by_tension() const {
  constexpr double tiny = 1e-20;
  const double step = tiny * std::max(std::abs(N), EI / (length * length));
  return at({N, step}).imag() / step;
}

}  // namespace fastjoint::stage3
