// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// An elastic disk that fills a hole: a pin whose rim deforms (docs/theory.md, section 6.7). The constants are those of
/// plane stress; in plane strain E / (1 - nu^2) and nu / (1 - nu) take their place.
struct ElasticDisk {
  double E = 0, nu = 0;  ///< stress; 0 for a hole without a disk

  friend bool operator==(const ElasticDisk&, const ElasticDisk&) = default;
  [[nodiscard]] bool is_given() const { return E > 0; }
  /// Normal compliance of the disk: inward displacement of its rim per unit pressure of the same distribution, (size),
  /// length / stress. It is a (2 n - 1 + nu) / (E (n^2 - 1)) for order n >= 2 and a (1 - nu) / E for order 0. It is 0
  /// for order 1, whose displacement is that of the disk as a whole.
  /// @param radius a, length. @param waves A whole rim, or a part between lines of symmetry.
  [[nodiscard]] Eigen::VectorXd yield(double radius, const Harmonics& waves) const;
  /// Inward displacement per unit shear on the sheet, whose reaction acts on the disk, (size, n_shears): a ((1 - nu) n
  /// - 2) / (E (n^2 - 1)) of the cosine for the sine of order n, and minus that of the sine for the cosine.
  [[nodiscard]] Eigen::MatrixXd yield_by_shear(double radius, const Harmonics& waves) const;
  /// Tangential compliance of the disk: displacement of its rim along the shear on it per unit shear of the same
  /// distribution, (n_shears), length / stress. It equals the normal compliance of that order. The tangential
  /// displacement per unit pressure is the transpose of yield_by_shear.
  [[nodiscard]] Eigen::VectorXd give_way(double radius, const Harmonics& waves) const;
};

}  // namespace fastjoint::rim
