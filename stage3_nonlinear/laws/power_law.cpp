// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// F = A (delta - delta0)^n past delta0, zero before: Bortman & Szabo, equation (7).
class PowerLaw final : public Law {
 public:
  PowerLaw(double A, double n, double delta0) : A_(A), n_(n), delta0_(delta0) {}

  [[nodiscard]] Branch at(double c, double k, double clearance) const override {
    const double s = c - k * gap(clearance);
    if (s < 0) return Branch::open(c, k);
    if (s == 0 && n_ < 1) return {.F = 0, .delta = c / k, .dF = 1, .ddelta = 0};
    const double F = force(s, k);
    const double x = stretch(F);
    const double dx = n_ == 1 ? 1 / A_ : x / (n_ * F);  // dx / dF
    return {.F = F, .delta = gap(clearance) + x, .dF = 1 / (1 + k * dx), .ddelta = dx / (1 + k * dx)};
  }

  [[nodiscard]] double coordinate(double F, double k, double clearance) const override {
    return F + k * (gap(clearance) + stretch(F));
  }

  [[nodiscard]] double gap(double clearance) const override { return delta0_ + clearance; }

  [[nodiscard]] std::optional<std::vector<double>> corners(double k, double clearance) const override {
    if (n_ < 1) return std::nullopt;
    const double c = k * gap(clearance);
    return c > 0 ? std::vector{c} : std::vector<double>{};
  }

  [[nodiscard]] std::vector<Parameter> parameters() const override {
    return {{"A", -n_, 1}, {"n", 0, 0}, {"delta0", 1, 0}};
  }

  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override {
    const Branch on = at(c, k, clearance);
    if (c < k * gap(clearance)) return std::vector<Slope>(4, {0, 0});
    // The change of delta at fixed F, converted to fixed c = F + k delta (docs/theory.md, section 10).
    const auto slope = [&](double d_delta) { return Slope{-k * d_delta * on.dF, d_delta * on.dF}; };
    const double x = stretch(on.F);
    const double x_log = on.F > 0 ? x * std::log(on.F / A_) : 0;  // its limit at first contact
    return {slope(1), slope(-x / (n_ * A_)), slope(-x_log / (n_ * n_)), slope(1)};
  }

  [[nodiscard]] std::vector<program::Warning> doubts() const override {
    constexpr double practical = 0.4;  // stated below equation (7) of the paper
    if (n_ >= practical) return {};
    return {{"exponent-low", fmt::format("n = {} is below the practical range {} to 1", n_, practical)}};
  }

 private:
  /// (F / A)^(1/n)
  [[nodiscard]] double stretch(double F) const { return n_ == 1 ? F / A_ : std::pow(F / A_, 1 / n_); }

  /// Force where F + k (F / A)^(1/n) is s > 0.
  [[nodiscard]] double force(double s, double k) const {
    if (n_ == 1) return s * (A_ / (A_ + k));
    // The function is convex and rises with F: started above the root, Newton's method approaches it from above.
    constexpr int max_iterations = 100;
    double F = std::min(s, A_ * std::pow(s / k, n_));
    for (int i = 0; i < max_iterations; ++i) {
      const double x = k * stretch(F);
      const double next = F - (F + x - s) / (1 + x / (n_ * F));
      if (!(next < F)) break;
      F = next;
    }
    return F;
  }

  double A_;       ///< force / length^n, A > 0
  double n_;       ///< exponent, 0 < n <= 1
  double delta0_;  ///< gap of the law, length, delta0 >= 0
};

}  // namespace

/// Reads {"type": "power", "A": ..., "n": ..., "delta0": 0}; delta0 may be left out.
LawPointer read_power_law(const input::Value& law) {
  law.only({"type", "A", "n", "delta0", "one_sided"});
  const double A = law.at("A").number(input::positive);
  const double n = law.at("n").number({.low = 0, .high = 1, .low_allowed = false});
  const auto delta0 = law.find("delta0");
  return std::make_shared<PowerLaw>(A, n, delta0 ? delta0->number(input::not_negative) : 0.0);
}

}  // namespace fastjoint::stage3
