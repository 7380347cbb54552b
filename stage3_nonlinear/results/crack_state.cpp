// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/crack_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::stage3 {
namespace {

/// Largest magnitude of the partial sums of a list's parts from index `from` up to, not including, `to`.
double largest_sum(const Eigen::RowVectorXd& parts, Index from, Index to) {
  double sum = 0, largest = 0;
  for (Index k = from; k < to; ++k) sum += parts[k], largest = std::max(largest, std::abs(sum));
  return largest;
}

/// Estimates the parts of K, (t), by waves above those that there are: what the last two octaves add, of each the
/// largest of its partial sums since parts may cancel, goes on falling with their ratio, which is 1/2 where stresses at
/// the ends of contact fall with n^-2.
VectorXd part_of_waves_above(const PlateModel& plate, const MatrixXd& K, const VectorXd& coefficients) {
  constexpr double slowest = 0.5;
  VectorXd above = VectorXd::Zero(K.rows());
  Index at = plate.n_externals() + std::ssize(plate.discs);
  for (Index i = 0; i < std::ssize(plate.contact); ++i)
    for (const Index n : {Index{plate.waves[i].waves.size()}, Index{plate.waves[i].waves.n_shears()}}) {
      for (Index t = 0; t < K.rows(); ++t) {
        const Eigen::RowVectorXd parts = K.row(t).segment(at, n).cwiseProduct(coefficients.segment(at, n).transpose());
        const double last = largest_sum(parts, n / 2, n), before = largest_sum(parts, n / 4, n / 2);
        const double ratio = before > 0 ? std::min(last / before, slowest) : slowest;
        above[t] += last * ratio / (1 - ratio);
      }
      at += n;
    }
  return above;
}

}  // namespace

CrackState crack_state(const PlateModel& plate, const VectorXd& coefficients) {
  if (plate.cracks.tips.empty()) return {};
  const auto &K_I = plate.cracks.K_I.back(), &K_II = plate.cracks.K_II.back();
  CrackState state{K_I * coefficients, K_II * coefficients, part_of_waves_above(plate, K_I, coefficients),
                   part_of_waves_above(plate, K_II, coefficients)};
  if (plate.contact.empty()) return state;
  constexpr double by_contact = 3e-4;  // of K, measured: the waves that are left out change where disc and rim touch
  for (VectorXd* part : {&state.K_I_waves, &state.K_II_waves}) *part += by_contact * state.K_I.cwiseAbs();
  return state;
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
