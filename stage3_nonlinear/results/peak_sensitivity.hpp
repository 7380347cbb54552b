// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {

/// Derivatives of hoop stresses by the numbers of the input.
struct PeakSensitivity {
  std::vector<std::string> hole;  ///< (r) "plate:hole" of each hole with a peak
  MatrixXd slopes;                ///< (r, JointNumbers::n_derivatives) stress per unit of the number
};

/// Derivatives of the hoop stress at the place of each hole's peak in one state, which are those of the peak itself
/// where it is a smooth maximum. Forces and displacements change by their exact slopes and by what a number does to
/// them directly; the hoop stress, which is linear in them but for contact, by its difference over a change of the
/// state by 1e-7. They are infinite where the forces have no derivative, and of holes without stress, where no place is
/// the peak yet.
[[nodiscard]] PeakSensitivity peak_sensitivity(const JointModel& joint, const JointNumbers& numbers,
                                               const StateSlopes& slopes, const SolvedPoint& point,
                                               const JointState& state);

}  // namespace fastjoint::stage3
