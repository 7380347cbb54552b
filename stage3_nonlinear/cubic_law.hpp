// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stage3_nonlinear/law.hpp"

namespace fastjoint::stage3 {

/// The cubic through (0, 0) and three measured points: Bortman & Szabo, equation (8).
///
/// Its coordinate is the stretch, times k: the cubic is smooth, and may lose monotonicity, so that the force
/// is none. Where the cubic is negative the fastener is spent: none pushes on in the direction of its
/// stretch.
class CubicLaw final : public Law {
 public:
  /// @param delta Three different stretches > 0, length.
  /// @param F     Forces there, force.
  CubicLaw(const std::array<double, 3>& delta, const std::array<double, 3>& F);
  [[nodiscard]] Branch beyond(double s, double k) const override;
  /// By the secant to the last point.
  [[nodiscard]] double coordinate(double F, double k) const override;
  [[nodiscard]] double last_stretch() const override { return last_; }
  [[nodiscard]] std::vector<std::string> doubts() const override;

 private:
  [[nodiscard]] double force(double x) const;
  [[nodiscard]] double slope(double x) const;

  double last_;                ///< largest of delta, length
  std::array<double, 3> a_{};  ///< F = x (a0 + a1 x + a2 x^2), x = stretch / last_
};

/// {"type": "cubic", "delta": [three], "F": [three]}
[[nodiscard]] std::shared_ptr<const Law> read_cubic_law(const input::Value& law);

}  // namespace fastjoint::stage3
