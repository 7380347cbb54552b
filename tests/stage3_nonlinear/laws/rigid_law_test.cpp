// SPDX-License-Identifier: GPL-3.0-or-later
// Joints whose fasteners are rigid past their clearance, against closed forms and very stiff linear laws.
#include <gtest/gtest.h>

#include "stage3_nonlinear/path/load_path.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/stage3_nonlinear/stacks.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;

std::shared_ptr<const Law> rigid_law() { return test::law_of(R"({"type": "rigid"})"); }

TEST(RigidLaw, IsTheLimitOfStiffLinearOnes) {
  std::mt19937 random(34);
  for (int i = 0; i < 40; ++i) {
    test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, 1 + i % 2, true);
    for (Index j = 0; j < joint.n_planes(); j += 1 + i % 3) joint.law[j] = test::linear_law(1e12);
    const PathStep stiff = test::solved(joint);
    for (Index j = 0; j < joint.n_planes(); j += 1 + i % 3) joint.law[j] = rigid_law();
    const PathStep step = test::solved(joint);
    EXPECT_LT((step.F - stiff.F).norm(), 1e-6 * stiff.F.norm()) << i;
    const Index a = joint.n_directions();
    for (Index j = 0; j < joint.n_planes(); j += 1 + i % 3) EXPECT_TRUE(step.delta.segment(j * a, a).isZero(0)) << i;
    const auto path = follow(make_equations(joint), {1}, test::tight);
    ASSERT_FALSE(path.failure);
    EXPECT_LT((path.steps[0].F - step.F).norm(), 1e-10 * step.F.norm()) << i;
  }
}

TEST(RigidLaw, HasAClearance) {
  // The joint of load_path_test.cpp at K = infinity: contact at P* = g / f, then both share what comes.
  constexpr double f = 1e-3, g = 0.06;
  auto joint = test::joint_of(test::two_fastener_lap(), rigid_law());
  joint.clearance[1] = g;
  const JointEquations equations = make_equations(joint);
  for (const double sign : {1.0, -1.0}) {
    const ExactPath exact = exact_path(equations, sign);
    ASSERT_EQ(exact.pieces.size(), 2U);
    EXPECT_NEAR(100 * exact.pieces[0].end, g / f, 1e-11);
    const LoadPath path = follow(equations, {0.3 * sign, sign}, test::tight);
    ASSERT_FALSE(path.failure);
    EXPECT_EQ(path.steps[0].F[1], 0);
    EXPECT_NEAR(path.steps[0].delta[1], sign * 30 * f, 1e-12);
    EXPECT_NEAR(path.steps[1].F[1], sign * (100 - g / f) / 2, 1e-10);
    EXPECT_EQ(path.steps[1].delta[0], 0);
    EXPECT_NEAR(path.steps[1].delta[1], sign * g, 1e-15) << "not more than its clearance";
  }
}

TEST(RigidLaw, BearsOnOneSideOfTheGround) {
  constexpr double s = 40, g = 0.1;
  auto joint = test::joint_of({test::disc_plate(MatrixXd::Constant(1, 1, s))});
  test::load_discs(joint, 0, VectorXd::Constant(1, 10));
  test::add_fastener(joint, {{0, 0}}, rigid_law(), true);
  joint.planes[0].one_sided = true;
  joint.clearance[0] = g;
  const JointEquations equations = make_equations(joint);
  const LoadPath path = follow(equations, {-1, 0.2, 1}, test::tight);
  ASSERT_FALSE(path.failure);
  EXPECT_NEAR(path.steps[0].delta[0], -10 / s, 1e-13);
  EXPECT_NEAR(path.steps[1].delta[0], 2 / s, 1e-13);
  EXPECT_EQ(path.steps[0].F[0], 0);
  EXPECT_EQ(path.steps[1].F[0], 0);
  EXPECT_NEAR(path.steps[2].F[0], 10 - s * g, 1e-12);
}

TEST(RigidLaw, HasACircleForAClearance) {
  constexpr double s = 40, g = 0.1;
  auto joint = test::joint_of({test::disc_plate(s * MatrixXd::Identity(2, 2), {"x", "y"})});
  test::load_discs(joint, 0, Vector2d(6, -8));
  test::add_fastener(joint, {{0, 0}}, rigid_law(), true);
  joint.clearance[0] = g;
  const LoadPath path = follow(make_equations(joint), {0.2, 1}, test::tight);
  ASSERT_FALSE(path.failure);
  EXPECT_LT((path.steps[0].delta - Vector2d(1.2, -1.6) / s).norm(), 1e-12);
  EXPECT_LT((path.steps[1].F - (10 - s * g) * Vector2d(0.6, -0.8)).norm(), 1e-11);
  EXPECT_LT((path.steps[1].delta - g * Vector2d(0.6, -0.8)).norm(), 1e-13);
}

}  // namespace
}  // namespace fastjoint::stage3
