// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "stage3_nonlinear/laws/law.hpp"
#include "stage3_nonlinear/laws/test_points.hpp"

namespace fastjoint::stage3 {

/// A measured curve that never falls: piecewise cubic through (0, 0) and its points with continuous slope, monotone
/// between points that are (Steffen, Astronomy & Astrophysics 239, 1990); beyond the last point straight on.
class TableLaw final : public Law {
 public:
  /// @param points (delta, F), at least two: delta > 0 rises, F > 0 does not fall.
  explicit TableLaw(const TestPoints& points);
  ~TableLaw() override;
  [[nodiscard]] Branch at(double c, double k, double clearance) const override;
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override;
  [[nodiscard]] double last_delta(double clearance) const override;
  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override;

 private:
  struct Spline;
  [[nodiscard]] std::array<double, 2> force_and_slope(double x) const;

  std::vector<double> x_, F_;  ///< points with (0, 0): stretch, length; force
  std::unique_ptr<Spline> spline_;
};

/// {"type": "table", "file": CSV} or {"type": "table", "delta": [...], "F": [...]}: points of a test, without (0, 0) or
/// with it.
[[nodiscard]] std::shared_ptr<const Law> read_table_law(const input::Value& law);

}  // namespace fastjoint::stage3
