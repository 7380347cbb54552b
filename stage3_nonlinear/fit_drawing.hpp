// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "stage3_nonlinear/fit_law.hpp"

namespace fastjoint::stage3 {

/// The points of a test, the law fitted to them and a band of its standard uncertainty, with axes: an SVG file.
///
/// The band is left out near contact, where the uncertainty of a power law is not below its force.
[[nodiscard]] std::string drawing(const Fit& fit, const TestPoints& points);

}  // namespace fastjoint::stage3
