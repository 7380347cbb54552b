// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage2_extract/field/fields.hpp"
#include "tests/support/rim_stress.hpp"

namespace fastjoint::test {

/// Other ways to the hoop stress at a rim, kept to measure that of tests/support/rim_stress.hpp against.

/// The finite element stress as it comes: (sigma_rr, sigma_tt, sigma_rt), mean of the sides, shape (3, k).
[[nodiscard]] Eigen::MatrixXd plain_rim_stress(const stage2::Fields& fields, const RimPoint& point);

/// The hoop strain at the rim of a quarter hole between lines of symmetry x = 0 and y = 0 from the first harmonics of
/// its displacement. Each is an integral of the displacement with a smooth weight, so that its error is the product of
/// two energy-norm errors, as that of S is; shape (n_points, k).
/// @param highest Highest harmonic, even.
[[nodiscard]] Eigen::MatrixXd harmonic_hoop_strain(const stage2::Fields& fields, const std::vector<RimPoint>& points,
                                                   int highest);

/// The same from the polynomial of degree p in the angle that fits the hoop strains at the p Gauss points of every side
/// of the quarter best, shape (n_points, k): patch recovery, Zienkiewicz & Zhu, Int. J. Numer. Meth. Engng 33,
/// 1331 (1992), along the rim.
[[nodiscard]] Eigen::MatrixXd patch_hoop_strain(const stage2::Fields& fields, const std::vector<RimPoint>& points);

}  // namespace fastjoint::test
