// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Bytes of the program and of the plates' matrices.
[[nodiscard]] double matrices_need(const JointScene& scene);

/// Throws InputError if there is too little memory to read the plates' matrices.
void require_memory_to_read(const JointScene& scene);

/// Bytes that a joint takes besides its matrices.
struct JointNeed {
  double solving, of_step;  ///< to solve it, and for the results of each increment
};
[[nodiscard]] JointNeed joint_need(const JointModel& joint, const Parameters& parameters, bool with_csv,
                                   bool with_sensitivities, bool with_rim_stresses);

}  // namespace fastjoint::stage3
