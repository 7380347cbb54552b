// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

/// F = A (delta - delta0)^n past delta0, zero before: Bortman & Szabo, equation (7).
class PowerLaw final : public Law {
 public:
  /// @param A      force / length^n, A > 0
  /// @param n      exponent, 0 < n <= 1
  /// @param delta0 gap of the law, length, delta0 >= 0
  PowerLaw(double A, double n, double delta0);
  [[nodiscard]] Branch at(double c, double k, double clearance) const override;
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override;
  [[nodiscard]] double gap(double clearance) const override { return delta0_ + clearance; }
  [[nodiscard]] std::optional<std::vector<double>> kinks(double k, double clearance) const override;
  [[nodiscard]] std::vector<Parameter> parameters() const override;
  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override;
  [[nodiscard]] std::vector<std::string> doubts() const override;

 private:
  /// Force where F + k (F / A)^(1/n) is s > 0.
  [[nodiscard]] double force(double s, double k) const;
  /// (F / A)^(1/n)
  [[nodiscard]] double stretch(double F) const;

  double A_, n_, delta0_;
};

/// {"type": "power", "A": ..., "n": ..., "delta0": 0}; delta0 may be left out.
[[nodiscard]] std::shared_ptr<const Law> read_power_law(const input::Value& law);

}  // namespace fastjoint::stage3
