// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <algorithm>

namespace fastjoint::stage3 {

/// Reciprocal condition number in the 1-norm, estimated; 0 if a pivot is 0, where Eigen's estimate divides by it and
/// may then drop the infinity that it meets.
[[nodiscard]] inline double reciprocal_condition(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) {
  return (lu.matrixLU().diagonal().array() == 0).any() ? 0 : lu.rcond();
}

/// Reciprocal condition number of a matrix that is of order 1, and so singular also if all of it is small.
[[nodiscard]] inline double least_stretch(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu, const Eigen::MatrixXd& A) {
  return reciprocal_condition(lu) * std::min(1.0, A.cwiseAbs().colwise().sum().maxCoeff());
}

}  // namespace fastjoint::stage3
