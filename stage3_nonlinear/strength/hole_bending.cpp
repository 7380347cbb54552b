// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/hole_bending.hpp"

#include <gsl/gsl_sf_bessel.h>

#include <cmath>
#include <numbers>

namespace fastjoint::stage3 {

double bending_concentration(double radius_by_thickness, double nu) {
  const double mu = std::sqrt(10.0) * radius_by_thickness;
  const double K0 = gsl_sf_bessel_K0_scaled(mu), K2 = gsl_sf_bessel_Kn_scaled(2, mu);
  return 1 + 2 * (1 + nu) * K2 / ((1 + nu) * K2 + 2 * K0);
}

PeakWithBending peak_with_bending(const Eigen::VectorXd& hoop, const std::array<std::array<double, 2>, 2>& along,
                                  double K, double nu) {
  PeakWithBending peak{std::nan(""), std::nan("")};
  const double step = 2 * std::numbers::pi / double(hoop.size());
  for (const double x : along[0])
    for (const double y : along[1])
      for (Eigen::Index i = 0; i < hoop.size(); ++i) {
        const double sum =
            hoop[i] + (1 + nu) * (x + y) - (1 - nu) * (K - 1) * (x - y) * std::cos((2 * double(i) + 1) * step);
        if (!(sum <= peak.value) && !std::isnan(sum)) peak = {sum, (double(i) + 0.5) * step};
      }
  constexpr double half = 180;
  const double degrees = peak.angle * half / std::numbers::pi;
  peak.angle = degrees > half ? degrees - 2 * half : degrees;
  return peak;
}

}  // namespace fastjoint::stage3
