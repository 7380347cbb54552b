// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/input/value.hpp"
#include "stage3_nonlinear/laws/flexibility_formula.hpp"

namespace fastjoint::stage3 {

/// Which terms of a published formula a law takes.
enum class FlexibilityMode {
  total,         ///< all: for sheets whose holes have springs that hardly give
  fastener_only  ///< what the bearing of the sheets does not make, because the springs around the holes have it
};

/// A fastener by a published formula.
struct Flexibility {
  double stiffness;  ///< of one shear plane, force / length: in double shear half of 1 / flexibility
  FlexibilityMode mode;
  FastenerGeometry geometry;
  std::string provenance;  ///< one sentence: formula, mode, shear, who and where, both flexibilities
};

/// Reads {"type": "formula", "formula": "huth bolt", "mode": "total" or "fastener only", "shear": "single" or "double",
/// "t": [t1, t2], "E": [E1, E2], "d": d, "E_f": E_f}, and "nu_f" where the formula uses it (FastenerGeometry);
/// "one_sided" is left to the caller. Throws InputError; a key or a shear that the formula does not know is refused by
/// its name.
[[nodiscard]] Flexibility read_flexibility(const input::Value& law);

}  // namespace fastjoint::stage3
