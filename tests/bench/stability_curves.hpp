// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "tests/bench/stability_joints.hpp"

namespace fastjoint::bench {

[[nodiscard]] double uniform(std::mt19937& random, double low, double high);
/// Even over the decades.
[[nodiscard]] double decades(std::mt19937& random, double low, double high);
[[nodiscard]] bool chance(std::mt19937& random, double share);

/// Size of a law: about the force F with the secant stiffness k.
struct LawSize {
  double F, k;
};

/// A power law with n from 0.4 to 1, a linear, bilinear (one in three perfectly plastic) or four-stage law, or a rising
/// cubic.
[[nodiscard]] Curve random_curve(std::mt19937& random, const LawSize& size);

}  // namespace fastjoint::bench
