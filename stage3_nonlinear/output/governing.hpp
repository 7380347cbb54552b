// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"

namespace fastjoint::stage3 {

/// Sets the increment that governs, and why: of a single case that could not be solved to its end the last one, else
/// that of the smallest margin, of the highest peak, or of the largest load that a shear plane transfers, whichever of
/// these is known first.
void set_governing(formats::JointResult& result);

}  // namespace fastjoint::stage3
