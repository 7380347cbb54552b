// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/angles.hpp"

namespace fastjoint::rim {

/// Most waves of a pressure around a hole.
inline constexpr int most_harmonics = 200;

/// Distributions of pressure over the part of a hole's circle that the model has, orthonormal in the mean over it: of a
/// whole circle 1, sqrt(2) cos(j theta), sqrt(2) sin(j theta), j = 1..highest; of the part from `start` on over
/// `sweep`, whose ends lie on lines of symmetry, 1 and sqrt(2) cos(j pi (theta - start) / sweep) up to the same wave
/// length.
struct Harmonics {
  int highest;               ///< j of the shortest wave of a whole circle
  double start = 0;          ///< radians counter-clockwise from x
  double sweep = full_turn;  ///< radians

  friend bool operator==(const Harmonics&, const Harmonics&) = default;
  [[nodiscard]] bool is_whole() const { return sweep == full_turn; }
  /// Number of distributions.
  [[nodiscard]] int size() const;
  /// Values of all of them at an angle, (size).
  [[nodiscard]] Eigen::VectorXd at(double angle) const;
  /// Their derivatives by the angle, (size).
  [[nodiscard]] Eigen::VectorXd slope(double angle) const;
  /// Integrals over theta of their products between two angles, shape (size, size), radians.
  [[nodiscard]] Eigen::MatrixXd products(double from, double to) const;
};

}  // namespace fastjoint::rim
