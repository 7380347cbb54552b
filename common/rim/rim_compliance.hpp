// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/harmonics.hpp"

namespace fastjoint::rim {

/// What tractions on the rim of a hole do to an infinite sheet, in closed form, for waves of any material that is the
/// same all around (docs/theory.md, section 11.2; Lekhnitskii, Anisotropic Plates, 1968).
///
/// Tractions are forces per area on the sheet: a pressure p along the normal n = (cos theta, sin theta), a shear along
/// the tangent (-sin theta, cos theta). A real function of theta is written as 2 Re sum f_m e^(-i m theta), m >= 1,
/// plus its mean.
class RimCompliance {
 public:
  /// @param compliance Strains (x, y, xy) of the sheet by its stresses, (3, 3), 1 / stress. @param radius Length.
  RimCompliance(const Eigen::Matrix3d& compliance, double radius);

  [[nodiscard]] double radius() const { return radius_; }
  /// The factor by which a wave of the rim's displacement falls from one order to the next, if what makes it lies at a
  /// place: a/s of an isotropic sheet, s the distance; else the largest 1/|zeta_k| there of Lekhnitskii's coordinates,
  /// a (1 - i mu_k) zeta_k / 2 + a (1 + i mu_k) / (2 zeta_k) = x + mu_k y. 1 on the rim and inside it.
  /// @param place From the hole's centre, length.
  [[nodiscard]] double fall(const Eigen::Vector2d& place) const;
  /// Strain along the rim by sigma_rr, sigma_tt and sigma_rt there, (3), 1 / stress.
  [[nodiscard]] Eigen::Vector3d along(double angle) const;
  /// (2, 2) complex, 1 / stress: the waves m of (du_x/dtheta, du_y/dtheta) over the radius by the waves m of the
  /// tractions (X, Y) along x and y; the same for every m >= 1. There is no singular case where both roots of
  /// Lekhnitskii's equation are one, as in an isotropic sheet: only their sum and product enter.
  [[nodiscard]] const Eigen::Matrix2cd& slope() const { return slope_; }
  /// Displacements of the rim, normal and tangential ones in the distributions of pressures and of shears, by
  /// tractions in the same distributions: shape (n, n), n = size + n_shears, symmetric, length / stress. Waves of order
  /// 0 and 1, which have a resultant or depend on what holds the sheet, are left zero.
  /// @param waves A whole rim, or a part that repeats.
  [[nodiscard]] Eigen::MatrixXd displacements(const Harmonics& waves) const;

 private:
  Eigen::Matrix3d compliance_;
  double radius_;
  Eigen::Vector2cd roots_;
  Eigen::Matrix2cd slope_;
};

}  // namespace fastjoint::rim
