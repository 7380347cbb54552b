// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"

namespace fastjoint::stage3 {

/// Derivatives of the n bearing forces by each parameter: those of the signed forces with one direction, those of their
/// magnitudes with two.
struct Sensitivity {
  VectorXd load_factor;   ///< (n) force
  MatrixXd clearance;     ///< (n, n) column: by the clearance of that plane, force / length
  MatrixXd law;           ///< (n, l) force per unit of the parameter
  MatrixXd mu;            ///< (n, f) force
  MatrixXd force;         ///< (n, u) by JointNumbers::force at load factor 1, dimensionless
  MatrixXd displacement;  ///< (n, v) by JointNumbers::displacement at load factor 1, force / length
  MatrixXd gap;           ///< (n, g) by the gap of each rim of contact, force / length
};

/// Derivatives of a solution by each parameter, in the order of JointNumbers.
struct StateSlopes {
  MatrixXd F, delta;                ///< (r, columns) of all rows of the condensed system
  MatrixXd Lambda;                  ///< (t, columns) of the amplitudes of friction
  MatrixXd load;                    ///< (l, columns) of the loads of the load cases
  std::vector<Index> none, no_row;  ///< columns without a derivative, and rows of F
};
[[nodiscard]] StateSlopes state_slopes(const JointNumbers& numbers, const SolvedPoint& point);

/// Derivatives at a solution, by the implicit function theorem for all parameters at once (docs/theory.md, section 10).
/// They are one-sided at a corner of F.
///
/// Forces on a plate that is free within its gaps (TangentCheck::mechanism) are differentiable by all parameters that
/// do not disturb its balance; derivatives by a load that would move it, and those of forces at a limit load, are
/// infinite.
[[nodiscard]] Sensitivity sensitivity(const JointNumbers& numbers, const StateSlopes& slopes, const SolvedPoint& point);

}  // namespace fastjoint::stage3
