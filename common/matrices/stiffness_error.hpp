// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace fastjoint::matrices {

/// Estimated absolute error of the last of condensed stiffness matrices of rising degree, shape (nc, nc), >= 0,
/// infinite if there is but one (docs/theory.md, section 5.1).
///
/// The error of what is smooth is overestimated, 5 times by the median, 50 times at most without rings around the
/// holes, up to 110 times with some, and what is singular (ends of clamped edges, of steps in thickness) is not
/// underestimated by more than 1.5 times, nor are slender cells, in 20967 cases
/// (tests/stage2_extract/matrices/effectivity_test.cpp and error_sweep_test.cpp). Exception: springs that end inside a
/// side of an element, up to twice: their differences fall as p^-(2 lambda + 1).
/// @param p Degrees, rising, shape (np). @param fastest The largest s that is believed.
[[nodiscard]] Eigen::MatrixXd stiffness_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& p,
                                              double fastest);

/// Estimated error of the last value of one falling sequence.
[[nodiscard]] double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& p, double fastest = 5);

/// The largest s for plates of these materials: 3 if one of them couples stretching and shear, else 5.
[[nodiscard]] double fastest_rate(const std::vector<Eigen::Matrix3d>& elasticity);

/// Matrices of a plate at each of its degrees: condensed stiffness, reactions to friction, compliance of tractions.
struct CondensedLevels {
  std::vector<Eigen::MatrixXd> S, R, C;
  double rounding = 0;  ///< what it may change of S, force / length
};

/// Estimated error of a matrix by its Frobenius norm, over that of the matrix.
struct RelativeError {
  const char* of;
  double value;
};

/// Errors at the highest degree of those of S, R and C_t that the plate has (docs/theory.md, section 5), of an S that
/// is zero over the norm of K_cc. Where friction's own field is rough, R converges more slowly than S (an annulus of
/// two layers: 1.9e-5, S 5e-7). True errors of R are up to 3.7 times as large, in 1 of 100 cases more than 1.5 times,
/// mostly in the trunk space, in slender laminates and at p = 3 and 4; those of C_t up to twice, in 1 of 1000 more than
/// 1.5 times (error_sweep_test.cpp).
[[nodiscard]] std::vector<RelativeError> relative_errors(const CondensedLevels& levels, const Eigen::VectorXi& p,
                                                         const Eigen::VectorXd& held_stiffness, double fastest);
[[nodiscard]] double largest(const std::vector<RelativeError>& errors);
/// "error of S about 6.10e-05, of R about 1.20e-04, of C_t below 1e-10".
[[nodiscard]] std::string to_text(const std::vector<RelativeError>& errors);

}  // namespace fastjoint::matrices
