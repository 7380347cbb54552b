// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/results/increments.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the stress intensity factors of one plate, (steps, t), stress length^1/2; infinite if the
/// matrices have one degree only, or if the joint does not converge at the degree below.
struct CrackErrors {
  MatrixXd K_I, K_II;
};

/// Errors of each plate's factors at every increment: the joint is solved again at up to two lower degrees, whose
/// sequence is extrapolated (geometric_error); in contact a quarter of the part by the upper half of the waves is
/// added.
/// @param scene As the joint was read from. @param path The joint's own.
[[nodiscard]] std::vector<CrackErrors> crack_errors(const JointScene& scene, const JointModel& joint,
                                                    const LoadPath& path, const std::vector<JointState>& states,
                                                    const PathOptions& options, double tolerance);

}  // namespace fastjoint::stage3
