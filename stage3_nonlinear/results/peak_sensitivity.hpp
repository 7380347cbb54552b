// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {

/// Derivatives of hoop stresses by the input parameters.
struct PeakSensitivity {
  std::vector<std::string> hole;  ///< (r) "plate:hole" of each hole with a peak
  MatrixXd slopes;                ///< (r, JointNumbers::n_derivatives) stress per unit of the parameter
};

/// Derivatives of the hoop stress at the fixed angle of each hole's peak in one state, which are those of the peak if
/// it is a smooth maximum. Forces and displacements have exact derivatives; the hoop stress, which is linear in them
/// except for contact, is differentiated by a difference with a relative change of the state of 1e-7. Derivatives are
/// infinite if those of the forces are, and for holes without stress, which have no peak.
[[nodiscard]] PeakSensitivity peak_sensitivity(const JointModel& joint, const JointNumbers& numbers,
                                               const StateSlopes& slopes, const SolvedPoint& point,
                                               const JointState& state);

}  // namespace fastjoint::stage3
