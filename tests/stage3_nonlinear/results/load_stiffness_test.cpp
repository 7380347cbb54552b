// SPDX-License-Identifier: GPL-3.0-or-later
// Tangent stiffness at the loads, against secants and differences of joints solved again.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/load_stiffness.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

TEST(LoadStiffness, OfALinearJointIsItsSecant) {
  const auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1000));
  const JointEquations equations = make_equations(joint);
  const LoadPath path = follow(equations, {0, 0.5, -1}, {});
  const double moved = joint_state(joint, equations, path.steps[1]).plates[0].De[0];
  for (const auto& step : path.steps) {
    const auto stiffness = tangent_stiffness(joint, test::point_of(equations, step));
    ASSERT_EQ(stiffness.size(), 1U) << "Q of no plate has a load";
    EXPECT_EQ(stiffness[0].external, "a:P");
    EXPECT_NEAR(stiffness[0].stiffness, 50 / moved, 1e-9 * 50 / moved);
  }
}

/// dP / du at plate a's external by joints solved a little below and above, with this change of the load factor.
double difference(const test::HandMade& joint, const JointEquations& equations, double change) {
  const LoadPath path = follow(equations, {1, 1 - change, 1 + change}, {{}, {.tolerance = 1e-13}});
  const PlateState below = joint_state(joint, equations, path.steps.at(1)).plates[0];
  const PlateState above = joint_state(joint, equations, path.steps.at(2)).plates[0];
  return (above.Pe[0] - below.Pe[0]) / (above.De[0] - below.De[0]);
}

TEST(LoadStiffness, OfRandomJointsIsThatOfDifferences) {
  std::mt19937 random(77);
  int compared = 0;
  for (int i = 0; i < 80; ++i) {
    auto joint = test::random_joint(random, {.friction = i % 2 == 0, .floating = i % 4 < 2});
    if (i % 3 == 0) {
      joint.force[{0, 0}] = 0;
      joint.displacement[{0, 0}] = 0.1;
    }
    const JointEquations equations = make_equations(joint);
    const double coarse = difference(joint, equations, 2e-4), fine = difference(joint, equations, 1e-4);
    if (!(std::abs(coarse - fine) < 1e-5 * std::abs(fine))) continue;  // a corner is near
    ++compared;
    const LoadPath path = follow(equations, {1}, {{}, {.tolerance = 1e-13}});
    EXPECT_NEAR(tangent_stiffness(joint, test::point_of(equations, path.steps[0]))[0].stiffness / fine, 1, 1e-5)
        << "joint " << i;
  }
  EXPECT_GT(compared, 60);
}

/// A yielded law that stays level: no more force, whatever the displacement.
TEST(LoadStiffness, AtALimitLoadIsZero) {
  auto joint = test::joint_of(test::two_fastener_lap(), test::bilinear_law(1000, 10, 0));
  joint.force[{0, 0}] = 20;
  const JointEquations equations = make_equations(joint);
  const LoadPath path = follow(equations, {1}, {});
  ASSERT_FALSE(path.failure);
  ASSERT_TRUE(path.steps[0].check.at_limit_load());
  EXPECT_EQ(tangent_stiffness(joint, test::point_of(equations, path.steps[0]))[0].stiffness, 0);
}

}  // namespace
}  // namespace fastjoint::stage3
