// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

namespace fastjoint::stage3 {

/// Concentration K_b of the bending stress at a hole of a wide plate that bends along one direction and is free to
/// curve across, by Reissner's theory of plates with shear: E. Reissner, The effect of transverse shear deformation on
/// the bending of elastic plates, J. Appl. Mech. 12, 1945, with mu = sqrt(10) a / t.
/// @param radius_by_thickness a / t, > 0. @param nu Poisson's ratio.
[[nodiscard]] double bending_concentration(double radius_by_thickness, double nu);

/// Largest sum of a hole's hoop stress and of that of bending on a face.
struct PeakWithBending {
  double value, angle;  ///< stress; degrees counter-clockwise from x, above -180 up to 180
};

/// @param hoop  Hoop stress of the solution in the plane, stress, in the middles of equal steps around the whole circle
///              from 0 degrees; NaN where not known. None: the result is NaN.
/// @param along Bending stress on the face along x and along y, stress: a value before and one behind the hole, of
///              which the worse counts. It is cylindrical: nu times it acts across.
/// @param K, nu bending_concentration and Poisson's ratio.
[[nodiscard]] PeakWithBending peak_with_bending(const Eigen::VectorXd& hoop,
                                                const std::array<std::array<double, 2>, 2>& along, double K, double nu);

}  // namespace fastjoint::stage3
