// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

/// The cubic through (0, 0) and three measured points: Bortman & Szabo, equation (8).
///
/// It may lose monotonicity. The fastener is spent where the cubic is negative, as none pushes on in the direction of
/// its stretch, and from where the cubic, fallen beyond its last point, rises again: no test showed the fastener do so.
class CubicLaw final : public Law {
 public:
  /// @param delta Three different stretches > 0, length.
  /// @param F     Forces there, force.
  CubicLaw(const std::array<double, 3>& delta, const std::array<double, 3>& F);
  [[nodiscard]] Branch at(double c, double k, double clearance) const override;
  /// By the secant to the last point.
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override;
  [[nodiscard]] bool rises() const override { return rises_; }
  [[nodiscard]] double least_slope() const override;
  [[nodiscard]] double last_delta(double clearance) const override { return clearance + last_; }
  [[nodiscard]] std::vector<Parameter> parameters() const override;
  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override;
  [[nodiscard]] std::vector<std::string> doubts() const override;

 private:
  /// A cubic F = x (a0 + a1 x + a2 x^2), x = stretch / last.
  struct Cubic {
    std::array<double, 3> a;
    [[nodiscard]] double force(double x) const { return x * (a[0] + x * (a[1] + x * a[2])); }
    [[nodiscard]] double slope(double x) const { return a[0] + x * (2 * a[1] + x * 3 * a[2]); }
    /// Where between 0 and `end` the slope is least.
    [[nodiscard]] double least(double end) const;
    /// Where the force rises again after it has fallen; infinite if it never does.
    [[nodiscard]] double second_rise() const;
  };
  static Cubic through(const std::array<double, 3>& x, const std::array<double, 3>& F);
  /// x where F + k last x is s > 0, of a cubic that rises.
  [[nodiscard]] double stretch(double s, double k) const;

  double last_;              ///< largest of delta, length
  std::array<double, 3> x_;  ///< delta / last
  Cubic cubic_;
  bool rises_;
  double end_;  ///< stretch / last beyond the last point from which the fastener is spent, or infinite
};

/// {"type": "cubic", "delta": [three], "F": [three]}
[[nodiscard]] std::shared_ptr<const Law> read_cubic_law(const input::Value& law);

}  // namespace fastjoint::stage3
