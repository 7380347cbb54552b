// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/path/path_result.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the n bearing forces (with two directions of their amounts) by those of the plates' matrices,
/// shape (steps, n), force; none if those of a plate are not known.
///
/// An error of a plate's matrices acts, to first order, as a load on its unknowns; implicit_slopes gives what that load
/// does to each force. The last change with p is extrapolated as the plate's energy is, and errors of several plates
/// are added without sign (docs/theory.md, section 5.3).
///
/// The file's own S_error counts for matrices of one degree, as from a laboratory, with the worst sign of every entry.
/// Errors of forces at a limit load are infinite.
[[nodiscard]] std::optional<Eigen::MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations,
                                                          const LoadPath& path, const std::vector<JointState>& states);

}  // namespace fastjoint::stage3
