// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Derivatives of the n bearing forces by each number: with one direction of the signed forces, with two of their
/// amounts.
struct Sensitivity {
  VectorXd load_factor;   ///< (n) force
  MatrixXd clearance;     ///< (n, n) column: by the clearance of that plane, force / length
  MatrixXd law;           ///< (n, l) force per unit of the number
  MatrixXd mu;            ///< (n, f) force
  MatrixXd force;         ///< (n, u) by JointNumbers::force at load factor 1, dimensionless
  MatrixXd displacement;  ///< (n, v) by JointNumbers::displacement at load factor 1, force / length
  MatrixXd gap;           ///< (n, g) by the gap of each rim of contact, force / length
};

/// Changes of a solution with each number, in the order of JointNumbers::n_derivatives.
struct StateSlopes {
  MatrixXd F, delta;        ///< (r, columns) of all rows of the condensed system
  std::vector<Index> none;  ///< columns without a derivative
};
[[nodiscard]] StateSlopes state_slopes(const JointEquations& equations, const JointNumbers& numbers,
                                       const PathStep& step);

/// Derivatives at one step, by the implicit function theorem with one factorisation of the tangent for all numbers
/// (docs/theory.md, section 10). They are one-sided where F has a corner.
///
/// Forces on a plate that gaps leave free (TangentCheck::mechanism) are differentiable by all numbers that leave it in
/// balance; derivatives by a load that would set it moving, and those of forces at a limit load, are infinite.
[[nodiscard]] Sensitivity sensitivity(const JointEquations& equations, const JointNumbers& numbers,
                                      const PathStep& step);

/// Estimated errors of the n bearing forces (with two directions of their amounts) by those of the plates' matrices,
/// shape (steps, n), force; none if those of a plate are not known.
///
/// An error of a plate's matrices acts, to first order, as a load on its unknowns; implicit_slopes gives what that load
/// does to each force. The last change with p is extrapolated as the plate's energy is, and errors of several plates
/// are added without sign (docs/theory.md, section 5.3).
///
/// The file's own S_error counts for matrices of one degree, as from a laboratory, with the worst sign of every entry.
/// Errors of forces at a limit load are infinite.
[[nodiscard]] std::optional<MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations,
                                                   const LoadPath& path, const std::vector<JointState>& states);

}  // namespace fastjoint::stage3
