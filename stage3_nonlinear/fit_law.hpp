// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "stage3_nonlinear/test_points.hpp"

namespace fastjoint::stage3 {

/// A law fitted to the points of a test by least squares of the force.
///
/// Uncertainties are standard ones (1 sigma): residual variance of the points past contact times the inverse of J^T J,
/// J the derivatives by the constants. Bates & Watts, Nonlinear Regression Analysis and its Applications, Wiley 1988,
/// section 2.2.
struct Fit {
  enum class Kind { power, cubic };
  Kind kind;
  /// Power: A, n, delta0 of F = A (delta - delta0)^n; cubic: a, b, c of F = a delta + b delta^2 + c delta^3.
  Eigen::Vector3d constants = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the constants; rows of those on a bound are zero
  std::array<bool, 3> on_bound{};  ///< power: n held at 1, delta0 at 0 or at the last point without force
  bool has_uncertainty = false;    ///< false with no more points than constants
  double last_delta = 0;           ///< of the points, length
  double rms = 0;                  ///< root of the mean square of the residuals, force
  int n_points = 0;
  std::vector<std::string> warnings = {};  ///< one sentence each
};

/// 0 < n <= 1 and delta0 >= 0; points before the first force only say that delta0 is not less. Throws InputError for
/// points that no such law fits, NumericalError if the search fails.
[[nodiscard]] Fit fit_power(const TestPoints& points);

/// Throws InputError for points that no such law fits.
[[nodiscard]] Fit fit_cubic(const TestPoints& points);

/// Force of the law at delta >= 0.
[[nodiscard]] double force(const Fit& fit, double delta);
/// Its standard uncertainty; 0 before contact.
[[nodiscard]] double force_uncertainty(const Fit& fit, double delta);

/// The three displacements by which a cubic is written: thirds of the last one.
[[nodiscard]] std::array<double, 3> cubic_deltas(const Fit& fit);

}  // namespace fastjoint::stage3
