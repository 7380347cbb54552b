// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

namespace fastjoint::stage3 {

/// Concentration of the bending stress at a hole of a wide plate that bends along one direction, by Reissner's theory
/// of plates with shear: E. Reissner, The effect of transverse shear deformation on the bending of elastic plates, J.
/// Appl. Mech. 12, 1945, with mu = sqrt(10) a / t.
/// @param radius_by_thickness a / t, > 0. @param nu Poisson's ratio.
[[nodiscard]] double bending_concentration(double radius_by_thickness, double nu);

/// Largest sum of a hole's hoop stress and of that of bending on a face.
struct PeakWithBending {
  double value, angle;  ///< stress; degrees counter-clockwise from x, above -180 up to 180
};

/// @param hoop  Hoop stress of the solution in the plane, at points in the middles of equal steps around the whole
/// circle from 0
///              degrees; NaN where not known. None: the result is NaN.
/// @param along Bending stress on the face along x and y: of each a value before and one behind the row, of which the
///              worse counts, stress.
/// @param K     bending_concentration. In cylindrical bending, in which the sheet does not curve across, nu times the
///              stress acts across too. @param nu Poisson's ratio.
[[nodiscard]] PeakWithBending peak_with_bending(const Eigen::VectorXd& hoop,
                                                const std::array<std::array<double, 2>, 2>& along, double K, double nu);

}  // namespace fastjoint::stage3
