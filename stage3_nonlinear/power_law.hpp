// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/law.hpp"

namespace fastjoint::stage3 {

/// F = A (delta - delta0)^n past delta0, zero before: Bortman & Szabo, equation (7). n = 1 is the linear law.
///
/// Its coordinate is the force: for n < 1 the slope dF/ddelta is infinite at first contact, ddelta/dF is
/// zero.
class PowerLaw final : public Law {
 public:
  /// @param A      force / length^n, A > 0
  /// @param n      exponent, 0 < n <= 1
  /// @param delta0 gap of the law, length, delta0 >= 0
  PowerLaw(double A, double n, double delta0);
  [[nodiscard]] double delta0() const override { return delta0_; }
  [[nodiscard]] Branch beyond(double s, double k) const override;
  [[nodiscard]] double coordinate(double F, double k) const override;
  [[nodiscard]] std::optional<double> stiffness() const override;
  [[nodiscard]] std::vector<std::string> doubts() const override;

 private:
  double A_, n_, delta0_;
};

/// {"type": "linear", "k": force / length}
[[nodiscard]] std::shared_ptr<const Law> read_linear_law(const input::Value& law);
/// {"type": "power", "A": ..., "n": ..., "delta0": 0}; delta0 may be left out.
[[nodiscard]] std::shared_ptr<const Law> read_power_law(const input::Value& law);

}  // namespace fastjoint::stage3
