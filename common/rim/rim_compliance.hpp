// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// Compliance of the rim of a hole in an infinite homogeneous anisotropic sheet, in closed form for harmonic tractions
/// (docs/theory.md, section 11.2; Lekhnitskii, Anisotropic Plates, 1968).
///
/// Tractions are forces per area on the sheet: a pressure p along the normal n = (cos theta, sin theta), a shear along
/// the tangent (-sin theta, cos theta). A real function of theta is written as 2 Re sum f_m e^(-i m theta), m >= 1,
/// plus its mean.
class RimCompliance {
 public:
  /// @param compliance Strains (x, y, xy) of the sheet per unit stress, (3, 3), 1 / stress. @param radius Length.
  RimCompliance(const Eigen::Matrix3d& compliance, double radius);

  [[nodiscard]] double radius() const { return radius_; }
  [[nodiscard]] const Eigen::Matrix3d& compliance() const { return compliance_; }
  /// The two roots with positive imaginary part of Lekhnitskii's equation, of which equal ones have half the digits.
  [[nodiscard]] const Eigen::Vector2cd& roots() const { return roots_; }
  /// Ratio of the rim's displacements of successive orders that a source at a place causes: a/s in an isotropic sheet
  /// at the distance s; in general the largest 1/|zeta_k| there of Lekhnitskii's coordinates, a (1 - i mu_k) zeta_k / 2
  /// + a (1 + i mu_k) / (2 zeta_k) = x + mu_k y. It is 1 on the rim and inside it.
  /// @param place Position relative to the hole's centre, length.
  [[nodiscard]] double fall(const Eigen::Vector2d& place) const;
  /// Strain along the rim per unit sigma_rr, sigma_tt and sigma_rt there, (3), 1 / stress.
  [[nodiscard]] Eigen::Vector3d along(double angle) const;
  /// Matrix from the waves m of the tractions (X, Y) along x and y to those of (du_x/dtheta, du_y/dtheta) over the
  /// radius, (2, 2) complex, 1 / stress; the same for every m >= 1. Equal roots of Lekhnitskii's equation, as in an
  /// isotropic sheet, are not singular, since only their sum and product enter.
  [[nodiscard]] const Eigen::Matrix2cd& slope() const { return slope_; }
  /// Compliance matrix of the rim: normal and tangential displacements in the distributions of pressures and shears,
  /// per unit traction in the same distributions; shape (n, n), n = size + n_shears, symmetric, length / stress. Rows
  /// and columns of order 0 and 1, which have a resultant or depend on the supports of the sheet, are zero.
  /// @param waves A whole rim, or a part between lines of symmetry.
  [[nodiscard]] Eigen::MatrixXd displacements(const Harmonics& waves) const;

 private:
  Eigen::Matrix3d compliance_;
  double radius_;
  Eigen::Vector2cd roots_;
  Eigen::Matrix2cd slope_;
};

}  // namespace fastjoint::rim
