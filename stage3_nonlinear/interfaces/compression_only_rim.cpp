// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/compression_only_rim.hpp"

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

CompressionOnlyRim::CompressionOnlyRim(const rim::Harmonics& pressures, double stiffness, double gap, double mu)
    : pressures_(pressures), stiffness_(stiffness), gap_(gap), mu_(mu) {
  constexpr double points_per_wave = 8;
  const double waves = std::max(1.0, pressures.highest * pressures.sweep / rim::full_turn);
  const auto n = static_cast<Index>(std::ceil(points_per_wave * waves)) + 1;
  auto samples = std::make_shared<Samples>();
  samples->angles = VectorXd::LinSpaced(n, pressures.start, pressures.start + pressures.sweep);
  samples->distributions.resize(n, pressures.size());
  for (Index i = 0; i < n; ++i) samples->distributions.row(i) = pressures.at(samples->angles[i]).transpose();
  samples_ = std::move(samples);
}

double CompressionOnlyRim::end_between(const VectorXd& m, double low, double high, bool rises) const {
  const double sign = rises ? 1 : -1;
  return rising_root(
      [&](double angle) {
        const auto [w, slope] = pressures_.sum_at(m, angle);
        return std::pair(sign * (w - gap_), sign * slope);
      },
      low, high);
}

double CompressionOnlyRim::extremum(const VectorXd& m, double angle, double sign) const {
  const double step = samples_->angles[1] - samples_->angles[0];
  double low = angle - step, high = angle + step;
  if (!pressures_.is_whole())
    low = std::max(low, samples_->angles[0]), high = std::min(high, samples_->angles[samples_->angles.size() - 1]);
  // The Illinois method finds the zero of the slope, which falls from low to high: a secant method that halves the
  // value at an end that stays twice.
  const auto slope = [&](double at) { return sign * pressures_.sum_at(m, at).second; };
  double at_low = slope(low), at_high = slope(high);
  if (at_low <= 0 || at_high >= 0) return at_low <= 0 ? low : high;
  constexpr int max_steps = 60;
  constexpr double tolerance = 1e-13;
  int side = 0;
  for (int i = 0; i < max_steps && high - low > tolerance; ++i) {
    const double middle = low + (high - low) * at_low / (at_low - at_high), here = slope(middle);
    if (here == 0) return middle;
    if (here > 0) {
      if (side > 0) at_high /= 2;
      low = middle, at_low = here, side = 1;
    } else {
      if (side < 0) at_low /= 2;
      high = middle, at_high = here, side = -1;
    }
  }
  return 0.5 * (low + high);
}

std::vector<CompressionOnlyRim::Point> CompressionOnlyRim::points(const VectorXd& m, const VectorXd& depth) const {
  const Index n = depth.size(), last = n - 1;
  std::vector<Point> points;
  points.reserve(n + 2);
  for (Index i = 0; i < n; ++i) points.push_back({samples_->angles[i], depth[i]});
  for (Index i = pressures_.is_whole() ? 0 : 1; i < last; ++i) {
    const double sign = depth[i] > 0 ? -1 : 1, here = sign * depth[i];
    const double before = sign * depth[i > 0 ? i - 1 : last - 1], after = sign * depth[i + 1];
    // The function rises above the highest of three samples by less than their range.
    if (before > here || after > here || 2 * here < std::min(before, after)) continue;
    double angle = extremum(m, samples_->angles[i], sign);
    const double there = this->depth(m, angle);
    if (angle < samples_->angles[0]) angle += pressures_.sweep;
    if (sign * there > 0) points.push_back({angle, there});
  }
  if (std::ssize(points) > n) std::ranges::sort(points, {}, &Point::angle);
  return points;
}

Touching CompressionOnlyRim::touching(const VectorXd& m) const {
  const VectorXd depth = samples_->distributions * m - VectorXd::Constant(samples_->angles.size(), gap_);
  const auto all = points(m, depth);
  Touching result{{}, MatrixXd::Zero(size(), size())};
  if (std::ranges::all_of(all, [](const Point& at) { return at.depth >= 0; })) {
    result.arcs.push_back({all.front().angle, all.back().angle});
    result.gram.setIdentity();
    return result;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool touches = all[i].depth > 0, before = i > 0 && all[i - 1].depth > 0;
    if (touches && !before)
      result.arcs.push_back({i > 0 ? end_between(m, all[i - 1].angle, all[i].angle, true) : all[i].angle, 0});
    if (before && !touches) result.arcs.back().to = end_between(m, all[i - 1].angle, all[i].angle, false);
  }
  if (all.back().depth > 0) result.arcs.back().to = all.back().angle;
  std::vector<rim::SignedRange> pieces;
  for (const auto& arc : result.arcs) pieces.push_back({arc.from, arc.to});
  if (!pieces.empty()) result.gram = pressures_.products(pieces) / pressures_.sweep;
  return result;
}

double CompressionOnlyRim::deepest(const VectorXd& m, double sign) const {
  Index at = 0;
  (sign * (samples_->distributions * m)).maxCoeff(&at);
  return extremum(m, samples_->angles[at], sign);
}

}  // namespace fastjoint::stage3
