// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

std::vector<JointState> states_of(const test::HandMade& joint, const JointEquations& equations, const LoadPath& path) {
  std::vector<JointState> states;
  for (const auto& step : path.steps) states.push_back(joint_state(joint, equations, step));
  return states;
}

TEST(Equilibrium, HoldsInEveryRowOfRandomJoints) {
  std::mt19937 random(41);
  for (int i = 0; i < 100; ++i) {
    const auto joint = test::random_joint(random, {.cubics = true, .friction = i % 2 == 0, .floating = i % 3 == 0});
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.5, -1}, {});
    ASSERT_FALSE(path.failure);
    for (const auto& state : states_of(joint, equations, path)) EXPECT_LT(state.out_of_balance, 1e-9) << "joint " << i;
  }
}

TEST(Equilibrium, SeesForcesThatDoNotBalance) {
  const auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1000));
  // Right forces at wrong displacements of the fasteners.
  EXPECT_GT(
      joint_state(joint, make_equations(joint), {1, Vector2d(50, 50), Vector2d(0.05, 0.06), 1, 0, {}}).out_of_balance,
      1e-2);
}

TEST(Equilibrium, ForcesOnAPlateAddUp) {
  // Plate a is pulled by 100 and held by nothing but fasteners; b's support takes it all.
  const auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1000));
  const JointEquations equations = make_equations(joint);
  const JointState state = states_of(joint, equations, follow(equations, {1}, {}))[0];
  EXPECT_EQ(state.plates[0].applied[0], 100);
  EXPECT_NEAR(state.plates[0].by_fasteners[0], -100, 1e-11);
  EXPECT_NEAR(state.plates[0].by_supports[0], 0, 1e-11);
  EXPECT_EQ(state.plates[1].applied[0], 0);
  EXPECT_NEAR(state.plates[1].by_supports[0], -100, 1e-11);
  EXPECT_EQ(state.plates[0].Pe[0], 100);
  // The support is the spring of 1000 at the first disc of b.
  EXPECT_NEAR(1000 * state.plates[1].D[0], 100, 1e-11);
  EXPECT_EQ(state.largest_force, 100);
}

TEST(Equilibrium, ForcesAlongYHaveASumOfTheirOwn) {
  auto lap = test::two_fastener_lap();
  lap.a.external_direction = {"y"};
  const auto joint = test::joint_of(lap, test::linear_law(1000));
  const JointEquations equations = make_equations(joint);
  const JointState state = states_of(joint, equations, follow(equations, {1}, {}))[0];
  EXPECT_EQ(state.plates[0].applied[0], 0);
  EXPECT_EQ(state.plates[0].applied[1], 100);
  EXPECT_EQ(state.plates[0].Pe[0], 100);
}

TEST(Equilibrium, FrictionHelpsToTransferOnTheSideThatBears) {
  std::mt19937 random(42);
  auto lap = test::two_fastener_lap();
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  lap.b.friction_resultant[2] = 0.002;  // hole 2, bearing +x: unlike the cosine distribution's 2 c / pi
  lap.b.friction_unit_force[2] = 0.01;
  auto joint = test::joint_of(lap, test::linear_law(1000));
  test::set_friction(joint, 0, 0.3);
  test::set_friction(joint, 1, 0.2);
  const JointEquations equations = make_equations(joint);
  const LoadPath path = follow(equations, {1, -1}, {});
  const auto states = states_of(joint, equations, path);
  const double cosine = 2 / std::numbers::pi;
  for (Index step : {0, 1}) {
    const VectorXd& F = path.steps[step].F;
    EXPECT_NEAR(states[step].transferred_first[0], F[0] * (1 + 0.3 * cosine), 1e-11);
    EXPECT_NEAR(states[step].transferred_second[0], F[0] * (1 + 0.3 * cosine), 1e-11);
    // Pushed to +x, hole 2 of b bears on its odd side; pushed back, on the usual one.
    const double share = (0.2 * cosine + (step == 0 ? 0.2 * 0.002 / 0.01 : 0.2 * cosine)) / 2;
    EXPECT_NEAR(states[step].transferred_first[1], F[1] * (1 + share), 1e-11);
    EXPECT_NEAR(states[step].transferred_second[1], F[1] * (1 + share), 1e-11);
    EXPECT_NEAR(states[step].plates[1].by_fasteners[0], states[step].transferred_second.sum(), 1e-11);
  }
}

TEST(Equilibrium, SharesAreOfTheSum) {
  const auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1));
  EXPECT_LT((shares(joint, Vector2d(30, 10)) - Vector2d(75, 25)).norm(), 1e-13);
  EXPECT_LT((shares(joint, Vector2d(-30, -10)) - Vector2d(75, 25)).norm(), 1e-13);
  EXPECT_TRUE(std::isnan(shares(joint, Vector2d(10, -10 * (1 + 1e-13)))[0])) << "a doubler's forces have no sum";
  EXPECT_TRUE(std::isnan(shares(joint, Vector2d(0, 0))[1]));
}

}  // namespace
}  // namespace fastjoint::stage3
