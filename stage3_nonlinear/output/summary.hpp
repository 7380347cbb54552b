// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// The summary on stdout: per increment the fasteners, the plates and how well all of it balances.
///
/// @param states  One per step of the path.
/// @param F_error (steps, n) of the forces, where it is known.
/// @param all_stresses Print those of every increment, not of the last alone.
[[nodiscard]] std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                                  const std::vector<JointState>& states, const std::optional<Eigen::MatrixXd>& F_error,
                                  bool all_stresses);

}  // namespace fastjoint::stage3
