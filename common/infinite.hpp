// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace fastjoint {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace fastjoint
