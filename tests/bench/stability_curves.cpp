// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/stability_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::bench {
namespace {

/// Curve from (0, 0) through its corners (delta, F), then on with a last slope.
struct Polyline {
  std::vector<std::array<double, 2>> corners;
  double last_slope;
};

Curve power(double A, double n) {
  return {test::power_law(A, n), [A, n](double delta, double clearance) -> Force {
            const double x = delta - clearance;
            if (x <= 0) return {0, 0};
            const double F = A * std::pow(x, n);
            return {F, n * F / x};
          }};
}

/// @param first_moved The clearance moves the corners from this one on.
Curve polyline(std::shared_ptr<const stage3::Law> law, const Polyline& line, std::size_t first_moved) {
  auto at = [line, first_moved](double delta, double clearance) -> Force {
    double x0 = 0, F0 = 0;
    for (std::size_t i = 0; i < line.corners.size(); ++i) {
      const double x1 = line.corners[i][0] + (i >= first_moved ? clearance : 0), F1 = line.corners[i][1];
      if (delta < x1) {
        const double slope = (F1 - F0) / (x1 - x0);
        return {F0 + slope * (delta - x0), slope};
      }
      x0 = x1;
      F0 = F1;
    }
    return {F0 + line.last_slope * (delta - x0), line.last_slope};
  };
  return {std::move(law), std::move(at)};
}

Curve bilinear(std::mt19937& random, const LawSize& size) {
  const double F = size.F * uniform(random, 0.3, 2);
  const double k_yield = chance(random, 1. / 3) ? 0 : size.k * decades(random, 1e-3, 0.5);
  return polyline(test::bilinear_law(size.k, F, k_yield), {{{0, 0}, {F / size.k, F}}, k_yield}, 0);
}

Curve four_stage(std::mt19937& random, const LawSize& size) {
  const double F_slip = size.F * uniform(random, 0.1, 1), F_yield = F_slip + size.F * uniform(random, 0.1, 1);
  const double k_stick = size.k * decades(random, 1, 10), k_bearing = size.k * decades(random, 0.3, 3);
  const double slip = size.F / size.k * uniform(random, 0, 1), stuck = F_slip / k_stick, slipped = stuck + slip;
  const double k_yield = chance(random, 1. / 3) ? 0 : size.k * decades(random, 1e-3, 0.2);
  auto law = test::law_of(fmt::format(R"({{"type": "four stage", "k_stick": {}, "F_slip": {}, "slip": {},
                                          "k_bearing": {}, "F_yield": {}, "k_yield": {}}})",
                                      k_stick, F_slip, slip, k_bearing, F_yield, k_yield));
  return polyline(std::move(law),
                  {{{stuck, F_slip}, {slipped, F_slip}, {slipped + (F_yield - F_slip) / k_bearing, F_yield}}, k_yield},
                  1);
}

Curve cubic(std::mt19937& random, const LawSize& size) {
  // F = F0 (a x + b x^2 + c x^3), x = delta k / F0, rises for all x > 0 if b^2 <= 3 a c.
  const double a = uniform(random, 0.1, 2), c = uniform(random, 0.01, 1);
  const double b = uniform(random, -0.98, 1) * std::sqrt(3 * a * c);
  const double unit = size.F / size.k, F0 = size.F;
  const auto F = [=](double x) { return F0 * x * (a + x * (b + x * c)); };
  return {test::cubic_law({unit, 2 * unit, 3 * unit}, {F(1), F(2), F(3)}),
          [=](double delta, double clearance) -> Force {
            const double x = (delta - clearance) / unit;
            if (x <= 0) return {0, 0};
            return {F(x), F0 / unit * (a + x * (2 * b + x * 3 * c))};
          }};
}

}  // namespace

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double decades(std::mt19937& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

bool chance(std::mt19937& random, double share) { return uniform(random, 0, 1) < share; }

Curve random_curve(std::mt19937& random, const LawSize& size) {
  switch (std::uniform_int_distribution<int>(0, 7)(random)) {
    case 0:
      return polyline(test::linear_law(size.k), {{{0, 0}}, size.k}, 0);
    case 1:
      return bilinear(random, size);
    case 2:
      return four_stage(random, size);
    case 3:
      return cubic(random, size);
    default: {
      const double n = chance(random, 0.1) ? 1 : uniform(random, 0.4, 1);
      return power(size.F / std::pow(size.F / size.k, n), n);
    }
  }
}

}  // namespace fastjoint::bench
