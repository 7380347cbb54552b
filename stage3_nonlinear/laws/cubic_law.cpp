// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/infinite.hpp"
#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// Cubic F = x (a0 + a1 x + a2 x^2), x = stretch / last.
struct Cubic {
  std::array<double, 3> a;

  static Cubic through(const std::array<double, 3>& x, const std::array<double, 3>& F) {
    // F / x is a parabola: Newton's divided differences give its coefficients. Those within rounding are set to zero,
    // since their signs would decide whether a straight line rises.
    const std::array<double, 3> g = {F[0] / x[0], F[1] / x[1], F[2] / x[2]};
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * *std::max_element(g.begin(), g.end());
    const auto change = [&](int i) { return std::abs(g[i + 1] - g[i]) > rounding ? g[i + 1] - g[i] : 0; };
    const double g01 = change(0) / (x[1] - x[0]), g12 = change(1) / (x[2] - x[1]);
    const double error = rounding / std::abs(x[1] - x[0]) + rounding / std::abs(x[2] - x[1]);
    const double g012 = std::abs(g12 - g01) > error ? (g12 - g01) / (x[2] - x[0]) : 0;
    return {{F[0] / x[0] - g01 * x[0] + g012 * x[0] * x[1], g01 - g012 * (x[0] + x[1]), g012}};
  }

  [[nodiscard]] double force(double x) const { return x * (a[0] + x * (a[1] + x * a[2])); }
  [[nodiscard]] double slope(double x) const { return a[0] + x * (2 * a[1] + x * 3 * a[2]); }

  /// The x between 0 and `end` at which the slope, a parabola, has its minimum: an end or the parabola's vertex.
  [[nodiscard]] double min_slope_at(double end) const {
    double worst = end < infinite && slope(end) < slope(0) ? end : 0;
    const double vertex = a[2] != 0 ? -a[1] / (3 * a[2]) : 0;
    if (vertex > 0 && vertex < end && slope(vertex) < slope(worst)) worst = vertex;
    return worst;
  }

  /// The x at which the force rises again after it has fallen; infinite if it never does.
  [[nodiscard]] double second_rise() const {
    const double root = a[1] * a[1] - 3 * a[0] * a[2];
    return a[2] > 0 && root > 0 ? (std::sqrt(root) - a[1]) / (3 * a[2]) : infinite;
  }
};

/// Cubic through (0, 0) and three measured points: Bortman & Szabo, equation (8).
///
/// The cubic may fall. The fastener counts as failed where the cubic is negative, and past a minimum of the cubic
/// beyond its last point, from where it would rise again: no test has shown such a rise.
class CubicLaw final : public Law {
 public:
  /// @param delta Three different stretches > 0, length.
  /// @param F     Forces there, force.
  CubicLaw(const std::array<double, 3>& delta, const std::array<double, 3>& F)
      : last_(*std::max_element(delta.begin(), delta.end())),
        x_{delta[0] / last_, delta[1] / last_, delta[2] / last_},
        cubic_(Cubic::through(x_, F)) {
    const bool rises_far_out = cubic_.a[2] > 0 || (cubic_.a[2] == 0 && cubic_.a[1] >= 0);
    rises_ = rises_far_out && cubic_.slope(cubic_.min_slope_at(infinite)) >= 0;
    const double valley = cubic_.second_rise();
    end_ = !rises_ && valley > 1 ? valley : infinite;
  }

  [[nodiscard]] Branch at(double c, double k, double clearance) const override {
    const double s = c - k * clearance;
    if (s < 0) return Branch::open(c, k);
    if (!rises_) {
      const double x = s / (k * last_);
      const bool failed = x > end_ || cubic_.force(x) < 0;
      return {.F = failed ? std::max(cubic_.force(std::min(x, end_)), 0.0) : cubic_.force(x),
              .delta = c / k,
              .dF = failed ? 0 : cubic_.slope(x) / (k * last_),
              .ddelta = 1 / k,
              .failed = failed};
    }
    const auto excess = [&](double x) {
      return std::pair(cubic_.force(x) + k * last_ * x - s, cubic_.slope(x) + k * last_);
    };
    const double x = s > 0 ? rising_root(excess, 0, s / (k * last_)) : 0;
    const double slope = cubic_.slope(x) / last_;
    return {.F = cubic_.force(x), .delta = clearance + x * last_, .dF = slope / (slope + k), .ddelta = 1 / (slope + k)};
  }

  /// Uses the secant to the last point.
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override {
    const double delta = clearance + last_ * F / cubic_.force(1);
    return rises_ ? F + k * delta : k * delta;
  }

  [[nodiscard]] bool rises() const override { return rises_; }

  [[nodiscard]] double min_slope() const override {
    if (rises_) return 0;
    double end = 1;  // the fastener fails before or near this x, or never
    while (end < end_ && cubic_.force(end) > 0 && end < 1e6) end *= 2;
    return std::min(0.0, cubic_.slope(cubic_.min_slope_at(end)) / last_);
  }

  [[nodiscard]] double last_delta(double clearance) const override { return clearance + last_; }

  [[nodiscard]] std::vector<Parameter> parameters() const override {
    return {{"F[0]", 0, 1}, {"F[1]", 0, 1}, {"F[2]", 0, 1}};
  }

  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override {
    const Branch on = at(c, k, clearance);
    if (c < k * clearance || on.failed) return std::vector<Slope>(4, {0, 0});
    const double x = (on.delta - clearance) / last_;
    // At constant c = F + k delta a gain of force reduces delta.
    const auto slope = [&](double gain) {
      return rises_ ? Slope{k * gain * on.ddelta, -gain * on.ddelta} : Slope{gain, 0};
    };
    std::vector<Slope> result{slope(-cubic_.slope(x) / last_)};
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> unit{};
      unit[i] = 1;
      result.push_back(slope(Cubic::through(x_, unit).force(x)));
    }
    return result;
  }

  [[nodiscard]] std::vector<program::Warning> doubts() const override {
    const double worst = cubic_.min_slope_at(1);
    if (cubic_.slope(worst) > 0) return {};
    return {{"cubic-falls",
             fmt::format("the cubic does not rise everywhere up to its last delta {}: its slope at delta = {:.4g} is "
                         "{:.4g}; the joint may have more than one solution",
                         last_, worst * last_, cubic_.slope(worst) / last_)}};
  }

 private:
  double last_;              ///< largest of delta, length
  std::array<double, 3> x_;  ///< delta / last
  Cubic cubic_;
  bool rises_;
  double end_;  ///< stretch / last of the minimum beyond the last point, past which the fastener counts as failed, or
                ///< infinite
};

}  // namespace

/// Reads {"type": "cubic", "delta": [three], "F": [three]}
LawPointer read_cubic_law(const input::Value& law) {
  law.only({"type", "delta", "F", "one_sided"});
  const auto deltas = law.at("delta");
  const auto delta = deltas.numbers(3, 3, input::positive);
  if (delta[0] == delta[1] || delta[1] == delta[2] || delta[0] == delta[2])
    deltas.not_allowed("three different displacements");
  const auto F = law.at("F").numbers(3, 3, input::positive);
  return std::make_shared<CubicLaw>(std::array{delta[0], delta[1], delta[2]}, std::array{F[0], F[1], F[2]});
}

}  // namespace fastjoint::stage3
