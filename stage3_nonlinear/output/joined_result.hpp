// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/formats/joint_result.hpp"

namespace fastjoint::stage3 {

/// Appends the increments of a load case to those of the cases before; the first case is appended to an empty result.
///
/// A rim with interference keeps the smallest load factor of all cases at which it loses full contact; stiffnesses at
/// externals that a case does not load are infinite there.
/// @param its Without sensitivities.
void append(formats::JointResult& all, const std::string& case_name, formats::JointResult its);

}  // namespace fastjoint::stage3
