// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/increments.hpp"

#include <gtest/gtest.h>

#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

const std::vector<double> factors{0.2, 0.5, 1, -0.7};

/// Errors, stiffnesses, sensitivities and the check of stability share the tangent of each increment.
void expect_one_tangent_each(const test::HandMade& joint) {
  const JointEquations equations = make_equations(joint);
  const Index before = SolvedPoint::n_factorised();
  const auto [path, all] =
      follow_with_results(joint, equations, factors, {}, {.tolerance = 1e-10, .sensitivities = true});
  ASSERT_FALSE(path.failure);
  EXPECT_EQ(SolvedPoint::n_factorised() - before, std::ssize(factors));
  EXPECT_EQ(std::ssize(all.states), std::ssize(factors));
  EXPECT_EQ(std::ssize(all.stiffness), std::ssize(factors));
  EXPECT_EQ(std::ssize(all.sensitivity), std::ssize(factors));
  EXPECT_TRUE(all.peak);
}

TEST(Increments, FactoriseTheTangentOnce) {
  std::mt19937 random(17);
  expect_one_tangent_each(test::random_joint(random, {}));
  expect_one_tangent_each(test::random_joint(random, {.friction = true}));
  expect_one_tangent_each(test::random_joint(random, {.cubics = true}));
}

}  // namespace
}  // namespace fastjoint::stage3
