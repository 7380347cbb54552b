// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "stage3_nonlinear/results/hoop_stress.hpp"

namespace fastjoint::stage3 {

/// Stresses of the sheet on a circle around a hole at a distance from its rim, where point-stress criteria of laminates
/// judge.
///
/// Displacements and tractions of the rim together fix Lekhnitskii's two potentials, and so the stresses wherever the
/// sheet has no border and one material between the rim and the circle (docs/theory.md, section 11.8). Waves that only
/// the tractions give decay, as in an infinite sheet; those of the elements have a part that grows outwards, by
/// (r/a)^m, and their errors with it.
class NearStress {
 public:
  /// @param rim Stress on the rim. @param distance From the rim, > 0, length.
  NearStress(const HoopStress& rim, double distance);

  /// sigma_rr, sigma_tt and sigma_rt at an angle, radians.
  [[nodiscard]] Eigen::Vector3d at(double angle) const;

 private:
  double radius_, distance_;
  std::array<std::complex<double>, 2> roots_;
  /// Derivatives of both potentials by the angle on the rim: coefficients of zeta^m and zeta^-m, m = 0.., (2, orders).
  Eigen::Matrix2Xcd growing_, decaying_;
};

}  // namespace fastjoint::stage3
