// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"

namespace fastjoint::stage3 {

/// Derivatives of a solution by each parameter, in the order of JointNumbers.
struct StateSlopes {
  MatrixXd F, delta;                ///< (r, columns) of all rows of the condensed system
  MatrixXd Lambda;                  ///< (t, columns) of the amplitudes of friction
  MatrixXd load;                    ///< (l, columns) of the loads of the load columns
  std::vector<Index> none, no_row;  ///< columns without a derivative, and rows of F
};
[[nodiscard]] StateSlopes state_slopes(const JointNumbers& numbers, const SolvedPoint& point);

/// Derivatives of the n bearing forces at a solution by each parameter, (n, columns): those of the signed forces with
/// one direction, those of their magnitudes with two; by the implicit function theorem for all parameters at once
/// (docs/theory.md, section 10). They are one-sided at a corner of F.
///
/// Forces on a plate that is free within its gaps (TangentCheck::mechanism) are differentiable by all parameters that
/// do not disturb its balance; derivatives by a load that would move it, and those of forces at a limit load, are
/// infinite.
[[nodiscard]] MatrixXd sensitivity(const StateSlopes& slopes, const SolvedPoint& point);

}  // namespace fastjoint::stage3
