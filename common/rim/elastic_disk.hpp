// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// An elastic disk that fills a hole, as a pin that yields in waves of its own (docs/theory.md, section 6.7). Its
/// constants are those of plane stress; in plane strain E / (1 - nu^2) and nu / (1 - nu) take their place.
struct ElasticDisk {
  double E = 0, nu = 0;  ///< stress; 0 of a hole without one

  friend bool operator==(const ElasticDisk&, const ElasticDisk&) = default;
  [[nodiscard]] bool is_given() const { return E > 0; }
  /// How far the rim of the disk yields inwards in each distribution of pressure, by an amount of it, (size), length /
  /// stress: a (2 n - 1 + nu) / (E (n^2 - 1)) of order n >= 2, a (1 - nu) / E of order 0. What order 1 does is the
  /// disk's displacement, from which the others are counted: 0.
  /// @param radius a, length. @param waves A whole rim, or a part that repeats.
  [[nodiscard]] Eigen::VectorXd yield(double radius, const Harmonics& waves) const;
  /// The same by the shears on the sheet, whose reactions the disk takes, (size, n_shears): a ((1 - nu) n - 2) / (E
  /// (n^2 - 1)) of the cosine by the sine, and minus that of the sine by the cosine.
  [[nodiscard]] Eigen::MatrixXd yield_by_shear(double radius, const Harmonics& waves) const;
  /// How far the rim of the disk gives way along the shears on it, in each distribution of them, (n_shears), length /
  /// stress: as to pressure of that order. To pressure it does by the transpose of yield_by_shear.
  [[nodiscard]] Eigen::VectorXd give_way(double radius, const Harmonics& waves) const;
};

}  // namespace fastjoint::rim
