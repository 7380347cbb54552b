// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3::load_path_test {
namespace {

using Eigen::VectorXd;
using test::ground;
using testing::ElementsAre;

/// Two fasteners K through two equal chains of segment flexibility f, the first pulled by P beyond fastener
/// 2, the second held before fastener 1; fastener 2 has a gap g. From delta_2 - delta_1 = f (F_1 - F_2):
/// open: F = (P, 0), delta_2 = P (1/K + f), so that contact comes at P* = g / (1/K + f); beyond: F_2 = (P -
/// P*) / 2.
class GapAtTheSecondFastener : public testing::Test {
 protected:
  static constexpr double K = 2000, f = 1e-3, g = 0.06, contact_load = g / (1 / K + f);  // 40
  static JointEquations equations(const std::shared_ptr<const Law>& second) {
    auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(K));
    joint.force[{0, 0}] = contact_load;
    joint.law[1] = second;
    joint.clearance[1] = g;
    return make_equations(joint);
  }
};

TEST_F(GapAtTheSecondFastener, ContactComesAtTheLoadOfTheClosedForm) {
  const LoadPath path = follow(equations(test::linear_law(K)), {0.5, 1 - 1e-9, 1, 1 + 1e-9, 2, 3, 0.5}, test::tight);
  ASSERT_FALSE(path.failure);
  for (const auto& step : path.steps) {
    const double P = step.load_factor * contact_load;
    const double F2 = std::max(0.0, (P - contact_load) / 2);
    EXPECT_NEAR(step.F[1], F2, 1e-10) << "load factor " << step.load_factor;
    EXPECT_NEAR(step.F[0], P - F2, 1e-10);
    EXPECT_NEAR(step.delta[0], (P - F2) / K, 1e-13);
  }
  EXPECT_EQ(path.steps[0].F[1], 0);
  EXPECT_EQ(path.steps[1].F[1], 0) << "a billionth below contact";
  EXPECT_NEAR(path.steps[3].F[1], 0.5e-9 * contact_load, 1e-11) << "a billionth above";
  EXPECT_NEAR(path.steps[2].delta[1], g, 1e-13);
}

TEST_F(GapAtTheSecondFastener, PowerLawHasItsClosedForm) {
  // (P - F_2)(1/K + f) - f F_2 = g + (F_2 / A)^2 for n = 1/2: a quadratic in F_2.
  constexpr double A = 300;
  const LoadPath path = follow(equations(test::power_law(A, 0.5)), {0.9, 1.2, 5, -5}, test::tight);
  ASSERT_FALSE(path.failure);
  const auto closed_form = [&](double P) {
    const double a = 1 / (A * A), b = 1 / K + 2 * f, c = g - P * (1 / K + f);
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
  };
  EXPECT_EQ(path.steps[0].F[1], 0);
  EXPECT_NEAR(path.steps[1].F[1], closed_form(1.2 * contact_load), 1e-10);
  EXPECT_NEAR(path.steps[2].F[1], closed_form(5 * contact_load), 1e-10);
  EXPECT_NEAR(path.steps[3].F[1], -closed_form(5 * contact_load), 1e-10) << "a round hole bears on both sides";
}

TEST_F(GapAtTheSecondFastener, CubicIsShiftedByTheGap) {
  const auto cubic = test::cubic_law({0.01, 0.02, 0.04}, {9.0, 15.0, 20.0});
  const LoadPath path = follow(equations(cubic), {1.5}, test::tight);
  ASSERT_FALSE(path.failure);
  const auto& step = path.steps[0];
  EXPECT_GT(step.delta[1], g);
  const double x = step.delta[1] - g;  // equation (8) in hundredths: 9, 15, 20 at 1, 2, 4
  const double z = 100 * x;
  EXPECT_NEAR(step.F[1],
              9 * (z - 2) * (z - 4) * z / 3 - 15 * (z - 1) * (z - 4) * z / 4 + 20 * (z - 1) * (z - 2) * z / 24, 1e-10);
  EXPECT_NEAR(step.delta[1] - step.delta[0], f * (step.F[0] - step.F[1]), 1e-13);
}

std::vector<double> reversing() { return {0.25, 0.5, 1, -1, 0.5}; }

/// The three first guesses find one solution; without friction it is unique (convex energy).
TEST(LoadPath, FirstGuessesAgree) {
  std::mt19937 random(31);
  for (int i = 0; i < 100; ++i) {
    const JointEquations equations =
        make_equations(test::random_joint(random, {.cubics = true, .floating = i % 2 == 0}));
    VectorXd first;
    for (const InitialScene& initial :
         {InitialScene{Guess::linear, std::nullopt}, InitialScene{Guess::linear, 10.0},
          InitialScene{Guess::rigid, std::nullopt}, InitialScene{Guess::equal, std::nullopt}}) {
      const LoadPath path = follow(equations, {1}, {initial, {.tolerance = 1e-12, .max_iterations = 200}});
      ASSERT_FALSE(path.failure) << "joint " << i;
      if (first.size() == 0) first = path.steps[0].F;
      EXPECT_LT((path.steps[0].F - first).norm(), 1e-8 * force_scale(equations, 1)) << "joint " << i;
    }
  }
}

/// docs/theory.md, section 8.4, with friction, one-sided fasteners and floating sheets too; the tolerance is the
/// default.
class RandomJoints : public testing::TestWithParam<test::RandomJoint> {};

TEST_P(RandomJoints, AllConverge) {
  std::mt19937 random(32);
  for (int i = 0; i < 300; ++i) {
    const auto joint = test::random_joint(random, GetParam());
    // One-sided fasteners cannot hold a floating sheet against a reversed load.
    const bool one_way = GetParam().one_sided && GetParam().floating;
    const LoadPath path =
        follow(make_equations(joint), one_way ? std::vector<double>{0.25, 0.5, 1, 0.5} : reversing(), {});
    EXPECT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps) EXPECT_LE(step.residual, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, RandomJoints,
                         testing::Values(test::RandomJoint{}, test::RandomJoint{.clearances = false},
                                         test::RandomJoint{.cubics = true}, test::RandomJoint{.friction = true},
                                         test::RandomJoint{.one_sided = true}, test::RandomJoint{.floating = true},
                                         test::RandomJoint{
                                             .cubics = true, .friction = true, .one_sided = true, .floating = true},
                                         test::RandomJoint{.least_n = 0.1}));

TEST(LoadPath, ReversedLoadMirrorsOddLaws) {
  std::mt19937 random(33);
  for (int i = 0; i < 50; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {.cubics = true}));
    const LoadPath path = follow(equations, {1, -1}, test::tight);
    ASSERT_FALSE(path.failure) << "joint " << i;
    EXPECT_LT((path.steps[0].F + path.steps[1].F).norm(), 1e-9 * force_scale(equations, 1)) << "joint " << i;
  }
}

/// Elastic laws forget: unloaded, nothing is left, and the way back meets the forces of the way up.
TEST(LoadPath, UnloadingReturnsTheWayItCame) {
  std::mt19937 random(35);
  for (int i = 0; i < 50; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {.friction = true}));
    const LoadPath path = follow(equations, {0.5, 1, 0.5, 0}, test::tight);
    ASSERT_FALSE(path.failure) << "joint " << i;
    EXPECT_LT((path.steps[2].F - path.steps[0].F).norm(), 1e-9 * force_scale(equations, 1)) << "joint " << i;
    EXPECT_EQ(path.steps[3].F.norm(), 0) << "joint " << i;
    EXPECT_EQ(path.steps[3].residual, 0) << "joint " << i;
  }
}

TEST(LoadPath, OneSidedFastenersDoNotPull) {
  std::mt19937 random(34);
  int open = 0;
  for (int i = 0; i < 50; ++i) {
    auto joint = test::random_joint(random, {});
    for (auto& plane : joint.planes) plane.one_sided = true;
    const LoadPath path = follow(make_equations(joint), {1, -1}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps) EXPECT_GE(step.F.minCoeff(), 0);
    open += path.steps[1].F.norm() == 0;
  }
  EXPECT_GT(open, 25) << "pushed the other way, most joints come apart";
}

TEST(LoadPath, LoadThatReachesNoFastenerGivesNoForce) {
  auto joint = test::joint_of(test::two_fastener_lap(), test::power_law(100, 0.5));
  joint.force[{0, 0}] = 0;
  const LoadPath path = follow(make_equations(joint), {1, 2}, {});
  ASSERT_FALSE(path.failure);
  EXPECT_EQ(path.steps[1].F.norm(), 0);
  EXPECT_EQ(path.steps[1].delta.norm(), 0);
}

TEST(LoadPath, StopsAfterHalvingsAndKeepsWhatConverged) {
  // A parabola F = x (1.1 - 0.1 x) f that turns down carries no more than its peak 3.025 f at x = 5.5: in
  // series with a sheet there is no equilibrium beyond.
  auto lap = test::Lap{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, ground, 1000}}), 1};
  auto joint = test::joint_of(lap, test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4}));
  const LoadPath path = follow(make_equations(joint), {1, 3, 3.5, 4}, {});
  ASSERT_TRUE(path.failure);
  ASSERT_EQ(path.steps.size(), 2U);
  EXPECT_NEAR(path.steps[1].F[0], 3, 1e-9);
  EXPECT_EQ(path.failure->increment, 2U);
  EXPECT_EQ(path.failure->load_factor, 3.5);
  EXPECT_GE(path.failure->reached, 3.025 - 0.5 / 64) << "halved six times";
  EXPECT_LE(path.failure->reached, 3.025);
  EXPECT_EQ(path.failure->entry, 0);
  EXPECT_GT(path.failure->residual, 1e-10);
}

/// Two fasteners that yield at 30 each and do not harden hold a sheet that nothing else holds: 100 is too much.
TEST(LoadPath, PerfectlyPlasticFastenersEndAtTheirLimitLoad) {
  const auto law = test::bilinear_law(1000, 30, 0);
  const LoadPath path = follow(make_equations(test::joint_of(test::two_fastener_lap(), law)), {0.59, 1}, {});
  ASSERT_EQ(path.steps.size(), 1U);
  EXPECT_NEAR(path.steps[0].F.sum(), 59, 1e-7);
  ASSERT_TRUE(path.failure);
  EXPECT_LE(path.failure->reached, 0.6 + 1e-9);
  EXPECT_GE(path.failure->reached, 0.6 - 0.41 / 64);
  EXPECT_GT(path.failure->residual, 1e-10);
}

TEST(LoadPath, FailedFastenersAreNoSolution) {
  // Both sheets hold themselves, so that the joint balances with its fastener far out where the cubic is
  // below zero.
  const test::Lap lap{test::spring_plate(1, 1, {{0, 1, 1000}, {0, ground, 1}}),
                      test::spring_plate(1, 0, {{0, ground, 1000}}), 1};
  const auto law = test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4});
  const LoadPath path = follow(make_equations(test::joint_of(lap, law)), {1, 20}, {});
  ASSERT_TRUE(path.failure);
  EXPECT_EQ(path.steps.size(), 1U);
  EXPECT_EQ(path.failure->entry, 0);
}

TEST(LoadPath, SmallStepsReachWhatOneStepWithFewIterationsDoesNot) {
  std::mt19937 random(35);
  int halved = 0;
  for (int i = 0; i < 100; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {}));
    const PathOptions few{{}, {.tolerance = 1e-10, .max_iterations = 3}};
    const LoadPath path = follow(equations, {1}, few);
    const LoadPath enough = follow(equations, {1}, test::tight);
    ASSERT_FALSE(enough.failure);
    if (path.failure) continue;
    // More than every start of both solvers in one step.
    halved += path.steps[0].iterations > 2 * 4 * 3;
    EXPECT_LT((path.steps[0].F - enough.steps[0].F).norm(), 1e-8 * force_scale(equations, 1)) << "joint " << i;
  }
  EXPECT_GT(halved, 0);
}

/// The limit of the method: a sheet that only fasteners hold has no stiffness while all of them are open.
class FloatingInItsGaps : public testing::Test {
 protected:
  /// A doubler on a sheet that stretches by 1/2000 per unit load between the fasteners.
  static test::Lap doubler() {
    return {test::chain(2, 1, 2000, {{1, 2, 1000}, {0, ground, 1000}}), test::chain(2, 0, 1000, {}), 1};
  }
  static test::HandMade joint(const test::Lap& lap, double gap, bool one_sided = false) {
    auto model = test::joint_of(lap, test::linear_law(500));
    model.clearance.assign(model.n_planes(), gap);
    for (auto& plane : model.planes) plane.one_sided = one_sided;
    return model;
  }
};

TEST_F(FloatingInItsGaps, ForcesAreFoundAndThePlaceIsSaidToBeOpen) {
  const LoadPath path = follow(make_equations(joint(doubler(), 1)), {100}, {});
  ASSERT_FALSE(path.failure);
  EXPECT_EQ(path.steps[0].F.norm(), 0);
  ASSERT_TRUE(path.steps[0].check.mechanism);
  EXPECT_THAT(path.steps[0].check.mechanism->open, ElementsAre(0, 1));
  // The doubler moves as one, the sheet does not.
  EXPECT_LT((path.steps[0].check.mechanism->motion - Eigen::Vector<double, 5>(0, 0, 0, 1, 1)).norm(), 1e-9);
}

TEST_F(FloatingInItsGaps, IsDeterminedOnceTheSheetHasStretched) {
  // It bears when the stretch exceeds both gaps: F = (-T, T), (P - T)/k2 = 2 g + T (1/kd + 2/K).
  const double P = 100, g = 0.01;
  const LoadPath path = follow(make_equations(joint(doubler(), g)), {P}, test::tight);
  ASSERT_FALSE(path.failure);
  const double T = (P / 2000 - 2 * g) / (1. / 2000 + 1. / 1000 + 2. / 500);
  EXPECT_NEAR(path.steps[0].F[0], -T, 1e-10);
  EXPECT_NEAR(path.steps[0].F[1], T, 1e-10);
  EXPECT_FALSE(path.steps[0].check.mechanism);
}

TEST_F(FloatingInItsGaps, ALoadedSheetFindsItsWayThroughWideGaps) {
  // The first sheet is held by fasteners only and pulled: it flies until they bear.
  for (const double gap : {1e-6, 1.0, 1e3}) {
    const LoadPath path = follow(make_equations(joint(test::two_fastener_lap(), gap)), {1, -1}, {});
    ASSERT_FALSE(path.failure) << "gap " << gap;
    EXPECT_NEAR(path.steps[0].F.sum(), 100, 1e-7);
    EXPECT_NEAR(path.steps[1].F.sum(), -100, 1e-7);
  }
}

TEST_F(FloatingInItsGaps, OneSidedFastenersCannotHoldItBack) {
  const LoadPath path = follow(make_equations(joint(test::two_fastener_lap(), 0.1, true)), {1, -1}, {});
  ASSERT_TRUE(path.failure);
  EXPECT_EQ(path.steps.size(), 1U);
  EXPECT_EQ(path.failure->increment, 1U);
  EXPECT_GE(path.failure->reached, 0) << "there is no equilibrium below zero load";
}

TEST(LoadPath, OfManyFastenersIsThatOfDampedNewton) {
  constexpr double k = 1e5;
  const auto iterations = [&](int n, Method method) {
    const JointEquations equations = make_equations(
        test::joint_of({test::chain(n, 1, k, {{n - 1, n, k}}), test::chain(n, 0, k, {{0, ground, k}}), 1e5},
                       test::power_law(3e4, 0.6)));
    PathOptions options;
    options.solver.method = method;
    return follow(equations, {1}, options).steps.at(0).iterations;
  };
  EXPECT_EQ(iterations(41, Method::fitting), iterations(41, Method::damped_newton));
  EXPECT_EQ(iterations(40, Method::fitting), iterations(40, Method::hybridsj));
  for (const int n : {40, 41}) EXPECT_NE(iterations(n, Method::hybridsj), iterations(n, Method::damped_newton));
}

}  // namespace
}  // namespace fastjoint::stage3::load_path_test
