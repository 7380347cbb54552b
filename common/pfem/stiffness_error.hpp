// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fastjoint::pfem {

/// Estimated absolute error of the last of condensed stiffness matrices of rising degree, shape (nc, nc), >= 0.
///
/// A diagonal entry S_ii is an energy, which falls towards its limit. Its differences are taken to go on falling as
/// p^-s, whose sum is the error: by the rate of the last difference and the last but two (between neighbours the trunk
/// space alternates), but not as if faster than s = 5. A singular point with displacements r^lambda gives 4 lambda + 1,
/// hides for long behind what converges exponentially, and then rules; s <= 5 is as if lambda = 1 ruled from here on.
/// So what is smooth is overestimated, 8 times at most without rings around the holes, up to 40 times with two, and
/// what is singular (ends of clamped edges, of steps in thickness) is not underestimated. Exceptions: springs that end
/// inside a side of an element (2 lambda + 1), up to 2.3 times; and the trunk space where a difference happens to be
/// small, 2.1 times in 2 of 1041 cases with rings. Theory: Szabo & Babuska, Finite Element Analysis (1991),
/// section 4.4; what it is worth: tests/stage2_extract/effectivity_test.cpp.
///
/// Off the diagonal the error is an energy product of two errors, at most the root of the product of their diagonals:
/// taken as the last difference is, and as 0.15 of that bound where the difference happens to pass through zero.
///
/// With fewer than four degrees s is 3; with one the error is infinite.
/// @param p Degrees, rising, shape (np).
[[nodiscard]] Eigen::MatrixXd stiffness_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& p);

/// The same for one falling sequence.
[[nodiscard]] double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& p);

/// Of S by the Frobenius norm: |error| / |S|, 0 if S is.
[[nodiscard]] double relative_error(const Eigen::MatrixXd& error, const Eigen::MatrixXd& S);

}  // namespace fastjoint::pfem
