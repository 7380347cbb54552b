// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <gmock/gmock.h>

#include "stage3_nonlinear/equations/first_guesses.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::ground;

/// Vogt's lap joint: plates of equal segments k between neighbouring fasteners. The first is pulled at its
/// end beyond the last fastener, the second held before the first fastener, so that between j and j + 1 the
/// first plate carries sum(F_i, i <= j) and the second sum(F_i, i > j): delta_{j+1} - delta_j = (their
/// difference) / k. With fasteners of two segments' flexibility, delta = 2 F / k: 2 (F_{j+1} - F_j) =
/// sum(F_i, i <= j) - sum(F_i, i > j).
test::Lap vogt(int n, double k) {
  return {test::chain(n, 1, k, {{n - 1, n, k}}), test::chain(n, 0, k, {{0, ground, k}}), 1};
}

TEST(LinearJoint, IsVogtsChain) {
  constexpr double k = 12345;
  const auto expect = [](int n, const std::vector<double>& forces) {
    const JointEquations equations = make_equations(test::joint_of(vogt(n, k), test::linear_law(k / 2)));
    const LoadPath path = follow(equations, {1}, {});
    for (int j = 0; j < n; ++j) EXPECT_NEAR(path.steps[0].F[j], forces[j], 1e-12) << n << " fasteners";
  };
  expect(3, {3. / 8, 1. / 4, 3. / 8});
  expect(5, {7. / 22, 3. / 22, 1. / 11, 3. / 22, 7. / 22});
}

TEST(LinearJoint, HoldsLongRows) {
  // 200 fasteners: the middle carries next to nothing, the ends share equally, the sum is the load.
  const JointEquations equations = make_equations(test::joint_of(vogt(200, 1000), test::linear_law(500)));
  const VectorXd F = follow(equations, {1}, {}).steps[0].F;
  EXPECT_NEAR(F.sum(), 1, 1e-12);
  EXPECT_NEAR(F[0], F[199], 1e-12);
  EXPECT_LT(std::abs(F[100]), 1e-12);
}

TEST(LinearJoint, IsLinearInTheLoad) {
  const JointEquations equations = make_equations(test::joint_of(vogt(3, 1000), test::linear_law(500)));
  const LoadPath path = follow(equations, {0.5, 1, -2}, {});
  ASSERT_EQ(path.steps.size(), 3U);
  for (const auto& step : path.steps) {
    EXPECT_NEAR(step.F[0], step.load_factor * 3 / 8, 1e-12);
    EXPECT_LT(step.residual, 1e-14);
    EXPECT_LT((step.delta - step.F / 500).norm(), 1e-16);
  }
}

TEST(LinearJoint, AgreesWithTheExactPath) {
  std::mt19937 random(21);
  for (int i = 0; i < 200; ++i) {
    auto joint =
        test::random_joint(random, {.least_n = 1, .clearances = false, .friction = i % 2 == 0, .floating = i % 3 == 0});
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.3, 1, -0.7}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps)
      EXPECT_LT((exact_forces(equations, step.load_factor) - step.F).norm(), 1e-10 * force_scale(equations, 1))
          << "joint " << i;
  }
}

TEST(LinearJoint, FrictionIsTakenOnTheSidesThatBear) {
  // The two senses of load bear on different sides, whose friction differs: not a mirror image.
  std::mt19937 random(22);
  auto lap = vogt(3, 1000);
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  auto joint = test::joint_of(lap, test::linear_law(500));
  for (Index j = 0; j < 3; ++j) test::set_friction(joint, j, 0.3);
  const LoadPath path = follow(make_equations(joint), {1, -1}, {});
  EXPECT_GT((path.steps[0].F + path.steps[1].F).norm(), 1e-3);
  EXPECT_LT(path.steps[1].residual, 1e-14);
}

TEST(LinearJoint, FrictionThatOutweighsItsForceHasNoConsistentSigns) {
  // One fastener whose friction outweighs its force: a column of H of -4 on one side and 4 on the other makes F > 0
  // need F (1 + 4 mu / c) = q, but without friction F = q < 0, and with it F turns round again.
  auto lap = test::Lap{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, ground, 1000}}), -1};
  std::mt19937 random(3);
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  auto joint = test::joint_of(lap, test::linear_law(1));
  test::set_friction(joint, 0, 0.3);
  auto system = condense(joint, joint.numbers().held);
  const FrictionLayout& layout = system.friction;
  for (const FrictionHole& hole : layout.friction_holes[0])
    for (const Side side : {plus_side, minus_side}) system.H(0, hole.sides[side].column) = 1e3;
  const auto equations =
      make_equations(joint, std::make_shared<const CondensedSystem>(std::move(system)), joint.numbers());
  EXPECT_FALSE(linear_forces(equations, VectorXd::Constant(1, 1.0), 1).consistent);
}

}  // namespace
}  // namespace fastjoint::stage3
