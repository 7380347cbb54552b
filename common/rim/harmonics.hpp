// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/rim/angles.hpp"

namespace fastjoint::rim {

/// Most waves of a pressure around a hole.
inline constexpr int most_harmonics = 200;

/// Part of a rim, radians counter-clockwise from x, whose integrals count times a sign.
struct SignedRange {
  double from, to, sign = 1;
};

/// Distributions of pressure and of shear over the part of a hole's circle that the model has, each kind orthonormal in
/// the mean over it: of a whole circle 1, sqrt(2) cos(j theta), sqrt(2) sin(j theta), j = 1..highest, for both; of the
/// part from `start` on over `sweep`, whose ends lie on lines of symmetry, 1 and sqrt(2) cos(j pi (theta - start) /
/// sweep) up to the same wave length, and of shear the sines of the same waves.
struct Harmonics {
  int highest;               ///< j of the shortest wave of a whole circle
  double start = 0;          ///< radians counter-clockwise from x
  double sweep = full_turn;  ///< radians

  friend bool operator==(const Harmonics&, const Harmonics&) = default;
  [[nodiscard]] bool is_whole() const { return sweep == full_turn; }
  /// True of a whole circle and of the half or quarter that lines of symmetry leave of one.
  [[nodiscard]] bool repeats() const;
  /// Number of pressures.
  [[nodiscard]] int size() const;
  /// Number of shears.
  [[nodiscard]] int n_shears() const { return is_whole() ? size() : size() - 1; }
  /// Values of all pressures at an angle, (size).
  [[nodiscard]] Eigen::VectorXd at(double angle) const;
  /// A sum of pressures at an angle and its derivative there, by amounts of each, (size).
  [[nodiscard]] std::pair<double, double> sum_at(const Eigen::VectorXd& amounts, double angle) const;
  /// A sum of shears at an angle, by amounts of each, (n_shears).
  [[nodiscard]] double shear_sum_at(const Eigen::VectorXd& amounts, double angle) const;
  /// Values of all shears at an angle, (n_shears).
  [[nodiscard]] Eigen::VectorXd shears_at(double angle) const;
  /// Means over the whole circle, or over the part that the model has along its line of symmetry, of pressures times
  /// the normal and of shears times the tangent (-sin theta, cos theta) along x (0) or y (1), (size), (n_shears).
  [[nodiscard]] Eigen::VectorXd push(int axis) const;
  [[nodiscard]] Eigen::VectorXd drag(int axis) const;
  /// The same pressures and shears as those of the whole circle up to the same wave length, which lines of symmetry
  /// make of a part that repeats: (2 highest + 1, size) and (2 highest + 1, n_shears), with orthonormal columns.
  [[nodiscard]] Eigen::MatrixXd pressures_of_whole() const;
  [[nodiscard]] Eigen::MatrixXd shears_of_whole() const;
  /// Sums over pieces of the rim of the integrals over theta of the products of pressures, shape (size, size), radians.
  [[nodiscard]] Eigen::MatrixXd products(std::span<const SignedRange> pieces) const;
  /// The same of shears with pressures, shape (n_shears, size), radians.
  [[nodiscard]] Eigen::MatrixXd shear_products(std::span<const SignedRange> pieces) const;
};

/// Waves of a rim that the finite elements carry: unit pressures and unit shears, and the displacements of the disc
/// against the sheet in the same distributions (docs/theory.md, section 6.2).
struct Waves {
  Harmonics shape;      ///< up to the highest order that the elements carry
  bool loaded = false;  ///< their tractions act in a joint, as those of contact do; else displacements alone are wanted

  friend bool operator==(const Waves&, const Waves&) = default;
  /// Number of pressures, then shears.
  [[nodiscard]] int size() const { return shape.size() + shape.n_shears(); }
};

/// Names of the friction cases of a hole whose springs also pull: + and - of each direction of its discs.
[[nodiscard]] std::vector<std::string> friction_cases(std::span<const std::string> directions);

}  // namespace fastjoint::rim
