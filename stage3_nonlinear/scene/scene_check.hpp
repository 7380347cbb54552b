// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

/// Checks the meaning of a joint as far as its own file tells: names that refer to something, and to it once.
/// Throws InputError.
void check_scene(const JointScene& scene);

}  // namespace fastjoint::stage3
