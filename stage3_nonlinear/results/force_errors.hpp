// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the n bearing forces (with two directions of their magnitudes) by those of the plates' matrices.
///
/// To first order an error of a plate's matrices is a load on its unknowns, and SolvedPoint::slopes gives the change of
/// each force by that load. The last change with p is extrapolated like the plate's energy, and the absolute values of
/// the errors of several plates are added (docs/theory.md, section 5.3).
///
/// Matrices of one degree, such as measured ones, have the S_error of the file, with the worst sign of every entry.
/// Errors of forces at a limit load are infinite.
class ForceErrors {
 public:
  /// @param joint, equations Outlive this.
  ForceErrors(const JointModel& joint, const JointEquations& equations);

  /// False if the errors of a plate's matrices are not known.
  [[nodiscard]] bool are_known() const { return are_known_; }
  /// Errors of the forces at a solution, (n), force; only if they are known.
  [[nodiscard]] VectorXd at(const SolvedPoint& point, const JointState& state) const;

 private:
  const JointModel& joint_;
  const JointEquations& equations_;
  bool are_known_;
};

}  // namespace fastjoint::stage3
