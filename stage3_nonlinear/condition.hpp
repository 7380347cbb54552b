// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/LU>

namespace fastjoint::stage3 {

/// Reciprocal condition number in the 1-norm, estimated; 0 if a pivot is 0, where Eigen's estimate divides by it and
/// may then drop the infinity that it meets.
[[nodiscard]] inline double reciprocal_condition(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) {
  return (lu.matrixLU().diagonal().array() == 0).any() ? 0 : lu.rcond();
}

}  // namespace fastjoint::stage3
