// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::test {

/// Infinite plate (plane stress) with a circular hole at the origin whose rim is held by distributed normal springs to
/// a fixed disc, under remote tension s along x. kappa = k a / E; kappa = 0 is Kirsch's open hole.
///
/// The stresses at rho = a/r: sigma_rr = s/2 (1 + A rho^2) + s/2 (1 + B rho^2 + C rho^4) cos 2 theta,
/// sigma_tt = s/2 (1 - A rho^2) - s/2 (1 + C rho^4) cos 2 theta, sigma_rt = -s/2 (1 - B/2 rho^2 - C rho^4) sin 2 theta.
/// The rim has no shear, C = 1 - B/2, and sigma_rr = k u_r there, which gives A and B (docs/theory.md, section 3.3).
class SpringInclusion {
 public:
  SpringInclusion(double E, double nu, double radius, double kappa, double tension)
      : E_(E),
        nu_(nu),
        a_(radius),
        s_(tension),
        A_((kappa * (1 - nu) - 1) / (1 + kappa * (1 + nu))),
        B_((kappa * 4 / 3 * (1 + nu) - 4) / (1 + kappa * (5 - nu) / 3)),
        C_(1 - B_ / 2) {}

  [[nodiscard]] Eigen::Vector2d displacement(const Eigen::Vector2d& x) const;
  [[nodiscard]] Eigen::Matrix2d stress(const Eigen::Vector2d& x) const;
  /// 4 sigma_rr / s = rim_mean + rim_second cos 2 theta at the rim.
  [[nodiscard]] double rim_mean() const { return 2 * (1 + A_); }
  [[nodiscard]] double rim_second() const { return 2 * (1 + B_ + C_); }

 private:
  double E_, nu_, a_, s_, A_, B_, C_;
};

}  // namespace fastjoint::test
