// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {

[[nodiscard]] double uniform(std::mt19937& random, double low, double high);
/// A number whose logarithm is uniform.
[[nodiscard]] double decades(std::mt19937& random, double low, double high);

/// Size of a random joint.
struct ContactKind {
  Index n_holes, n_directions;
  bool floating;  ///< the first plate hangs on its fasteners alone
  double gaps;    ///< their size beside what the load moves
  double mu = 0;
  bool short_waves = false;  ///< rims have them, and every other one an elastic disk
};

/// Two elastic bodies of random stiffness, joined through holes whose rims push but do not pull.
[[nodiscard]] test::HandMade random_contact_joint(std::mt19937& random, const ContactKind& kind);

class ContactJoint : public testing::Test {
 protected:
  std::mt19937 random_{14};
  ContactKind kind(int i) { return {1 + i % 4, 1 + i % 2, i % 3 == 0, decades(random_, 1e-4, 1e2), 0, i / 4 % 2 == 1}; }
};

}  // namespace fastjoint::stage3
