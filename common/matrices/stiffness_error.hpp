// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace fastjoint::matrices {

/// Estimates the absolute error of the last of a sequence of condensed stiffness matrices of rising degree, shape (nc,
/// nc), >= 0; infinite for a single matrix (docs/theory.md, section 5.1).
///
/// In 20967 cases (tests/stage2_extract/matrices/effectivity_test.cpp and error_sweep_test.cpp), errors of smooth
/// solutions are overestimated: 5 times in the median, at most 50 times without rings around the holes and 110 times
/// with rings. Errors of singular solutions (ends of clamped edges and of steps in thickness) and of slender cells are
/// underestimated at most 1.5 times, those of springs that end inside a side of an element, whose differences fall as
/// p^-(2 lambda + 1), at most twice.
/// @param p Degrees, rising, shape (n_p). @param max_rate Upper limit of the estimated rate s of convergence p^-s.
[[nodiscard]] Eigen::MatrixXd stiffness_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& p,
                                              double max_rate);

/// Estimates the error of the last value of one falling sequence.
[[nodiscard]] double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& p, double max_rate = 5);

/// Upper limit of the rate s for plates of these materials: 3 if one of them couples stretching and shear, else 5.
[[nodiscard]] double max_rate_of(const std::vector<Eigen::Matrix3d>& elasticity);

/// Matrices of a plate at each of its degrees: condensed stiffness, reactions to friction, compliance of tractions.
struct CondensedLevels {
  std::vector<Eigen::MatrixXd> S, R, C;
  double rounding = 0;  ///< bound of the change of S by rounding, force / length
};

/// Estimated relative error of a matrix in the Frobenius norm.
struct RelativeError {
  const char* of;
  double value;
};

/// Estimates the errors at the highest degree of those of S, R and C_t that the plate has (docs/theory.md, section 5).
/// The error of an S that is zero is relative to the diagonal of K_cc. R converges more slowly than S where the field
/// of the friction load is rough (an annulus of two layers: 1.9e-5, S 5e-7). True errors of R are up to 3.7 times the
/// estimate, in 1 of 100 cases more than 1.5 times, mostly in the trunk space, in slender laminates and at p = 3 and 4;
/// those of C_t up to twice, in 1 of 1000 more than 1.5 times (error_sweep_test.cpp).
[[nodiscard]] std::vector<RelativeError> relative_errors(const CondensedLevels& levels, const Eigen::VectorXi& p,
                                                         const Eigen::VectorXd& diagonal_of_K_cc, double max_rate);
[[nodiscard]] double largest(const std::vector<RelativeError>& errors);
/// "error of S about 6.10e-05, of R about 1.20e-04, of C_t below 1e-10".
[[nodiscard]] std::string to_text(const std::vector<RelativeError>& errors);

}  // namespace fastjoint::matrices
