// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/crack_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::stage3 {
namespace {

/// Amplitudes of the upper half of the waves of each rim of contact, the others 0.
VectorXd upper_half(const PlateModel& plate, const VectorXd& coefficients) {
  VectorXd result = VectorXd::Zero(coefficients.size());
  Index at = plate.n_externals() + std::ssize(plate.discs);
  for (Index i = 0; i < std::ssize(plate.contact); ++i)
    for (const Index n : {Index{plate.waves[i].waves.size()}, Index{plate.waves[i].waves.n_shears()}}) {
      result.segment(at + n / 2, n - n / 2) = coefficients.segment(at + n / 2, n - n / 2);
      at += n;
    }
  return result;
}

}  // namespace

CrackState crack_state(const PlateModel& plate, const VectorXd& coefficients) {
  if (plate.cracks.tip.empty()) return {};
  const auto &K_I = plate.cracks.K_I.back(), &K_II = plate.cracks.K_II.back();
  const VectorXd upper = upper_half(plate, coefficients);
  return {K_I * coefficients, K_II * coefficients, K_I.cwiseAbs() * upper.cwiseAbs(),
          K_II.cwiseAbs() * upper.cwiseAbs()};
}

double geometric_error(const VectorXd& values) {
  constexpr double fastest = 0.15, slowest = 0.8, of_two = 0.5, rounding = 1e-12;
  const Index n = values.size();
  if (n < 2) return std::numeric_limits<double>::infinity();
  const double last = std::abs(values[n - 1] - values[n - 2]);
  const double before = n > 2 ? std::abs(values[n - 2] - values[n - 3]) : last / of_two;
  const double change = std::max(last, fastest * before);  // a difference may be small by a change of sign
  const double ratio = before > 0 ? std::clamp(change / before, fastest, slowest) : slowest;
  return std::max(change * ratio / (1 - ratio), rounding * std::abs(values[n - 1]));
}

}  // namespace fastjoint::stage3
