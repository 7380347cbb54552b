// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the n bearing forces (with two directions of their amounts) by those of the plates' matrices.
///
/// An error of a plate's matrices acts, to first order, as a load on its unknowns; SolvedPoint::slopes gives what that
/// load does to each force. The last change with p is extrapolated as the plate's energy is, and errors of several
/// plates are added without sign (docs/theory.md, section 5.3).
///
/// The file's own S_error counts for matrices of one degree, as from a laboratory, with the worst sign of every entry.
/// Errors of forces at a limit load are infinite.
class ForceErrors {
 public:
  /// @param joint, equations Outlive this.
  ForceErrors(const JointModel& joint, const JointEquations& equations);

  /// False if the errors of a plate's matrices are not known.
  [[nodiscard]] bool are_known() const { return are_known_; }
  /// Errors of the forces at a solution, (n), force. Only where they are known.
  [[nodiscard]] VectorXd at(const SolvedPoint& point, const JointState& state) const;

 private:
  const JointModel& joint_;
  const JointEquations& equations_;
  bool are_known_;
  /// Changes of the plates' stiffness with the last degree, over the shear planes: D_delta^T dS D_delta of each, its
  /// lower triangle with half the diagonal, (r, r); empty of a plate of one degree.
  std::vector<MatrixXd> stiffness_changes_;
};

}  // namespace fastjoint::stage3
