// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/rim/angles.hpp"
#include "common/rim/axis.hpp"

namespace fastjoint::rim {

/// Highest allowed order of the waves around a hole.
inline constexpr int max_harmonics = 200;

/// Part of a rim, radians counter-clockwise from x, with the sign of its integrals.
struct SignedRange {
  double from, to, sign = 1;
};

/// Fourier basis of pressure and of shear over the part of a hole's circle that the model has, each orthonormal in the
/// mean over it. On a whole circle both have 1, sqrt(2) cos(j theta), sqrt(2) sin(j theta), j = 1..highest. On the part
/// from `start` over `sweep` between lines of symmetry, pressure has 1 and sqrt(2) cos(j pi (theta - start) / sweep) up
/// to the same wave length, and shear the sines of the same waves.
struct Harmonics {
  int highest;               ///< highest order j on a whole circle
  double start = 0;          ///< radians counter-clockwise from x
  double sweep = full_turn;  ///< radians

  friend bool operator==(const Harmonics&, const Harmonics&) = default;
  [[nodiscard]] bool is_whole() const { return sweep == full_turn; }
  /// True for a whole circle and for the half or quarter of one between lines of symmetry.
  [[nodiscard]] bool repeats() const;
  /// Number of pressures.
  [[nodiscard]] int size() const;
  /// Number of shears.
  [[nodiscard]] int n_shears() const { return is_whole() ? size() : size() - 1; }
  /// Values of all pressures at an angle, (size).
  [[nodiscard]] Eigen::VectorXd at(double angle) const;
  /// Value and derivative at an angle of the pressure with these coefficients, (size).
  [[nodiscard]] std::pair<double, double> sum_at(const Eigen::VectorXd& coefficients, double angle) const;
  /// Value at an angle of the shear with these coefficients, (n_shears).
  [[nodiscard]] double shear_sum_at(const Eigen::VectorXd& coefficients, double angle) const;
  /// Values of all shears at an angle, (n_shears).
  [[nodiscard]] Eigen::VectorXd shears_at(double angle) const;
  /// Normal and tangential resultants: means over the circle, or the part of it in the model, of the components along x
  /// (axis 0) or y (axis 1) of pressures times the normal, (size), and of shears times the tangent (-sin theta, cos
  /// theta), (n_shears). On a half circle only the component along its line of symmetry is counted, on a quarter none.
  [[nodiscard]] Eigen::VectorXd push(int axis) const;
  [[nodiscard]] Eigen::VectorXd drag(int axis) const;
  /// Pressures and shears of a part between lines of symmetry, continued to the whole circle, as coefficients of its
  /// basis: (2 highest + 1, size) and (2 highest + 1, n_shears), with orthonormal columns.
  [[nodiscard]] Eigen::MatrixXd pressures_of_whole() const;
  [[nodiscard]] Eigen::MatrixXd shears_of_whole() const;
  /// Gram matrix of the pressures: integrals over theta of their products, summed over pieces of the rim, (size, size),
  /// radians.
  [[nodiscard]] Eigen::MatrixXd products(std::span<const SignedRange> pieces) const;
  /// The same for products of shears and pressures, (n_shears, size), radians.
  [[nodiscard]] Eigen::MatrixXd shear_products(std::span<const SignedRange> pieces) const;
};

/// Waves of a rim that the finite elements resolve: unit pressures and shears, and the displacements of the disc
/// relative to the sheet in the same distributions (docs/theory.md, section 6.2).
struct Waves {
  Harmonics shape;      ///< basis up to the highest order that the elements resolve
  bool loaded = false;  ///< true if their tractions occur in a joint (contact); else only displacements are needed

  friend bool operator==(const Waves&, const Waves&) = default;
  /// Number of pressures and shears.
  [[nodiscard]] int size() const { return shape.size() + shape.n_shears(); }
};

/// Names of the friction cases of a hole whose springs also carry tension: + and - of each direction of its discs.
[[nodiscard]] std::vector<std::string> friction_cases(std::span<const Axis> directions);

}  // namespace fastjoint::rim
