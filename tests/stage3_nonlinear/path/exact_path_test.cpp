// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/sweep.hpp"

namespace fastjoint::stage3::exact_path_test {
namespace {

using Eigen::VectorXd;
using test::ground;

/// Largest residual of all laws at a load factor, relative to the load.
double residual(const JointEquations& equations, const ExactPath& path, double load_factor) {
  const auto state = contact_state(equations, path.at(load_factor));
  return equations.residual(state, load_factor).cwiseAbs().maxCoeff() / force_scale(equations, 1);
}

/// The joint of load_path_test.cpp: contact at P* = g / (1/K + f).
TEST(ExactPath, CornerIsTheContactOfTheClosedForm) {
  constexpr double K = 2000, f = 1e-3, g = 0.06;
  auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(K));
  joint.clearance[1] = g;
  const JointEquations equations = make_equations(joint);
  for (const double sign : {1.0, -1.0}) {
    const ExactPath path = exact_path(equations, sign);
    ASSERT_EQ(path.pieces.size(), 2U);
    EXPECT_EQ(path.sign, sign);
    EXPECT_NEAR(100 * path.pieces[0].end, g / (1 / K + f), 1e-11);
    EXPECT_EQ(path.reach(), 1);
    const VectorXd F = contact_state(equations, path.at(sign)).F;
    EXPECT_NEAR(F[1], sign * (100 - g / (1 / K + f)) / 2, 1e-11);
  }
}

TEST(ExactPath, EqualGapsOfASymmetricJointCloseTogether) {
  // Three equal springs to the ground, each with a fastener of the same gap, under equal loads: a tie of three.
  constexpr double gap = 0.01, k = 1000, K = 3000;
  auto joint = test::joint_of({test::spring_plate(3, 1, {{0, 3, k}, {1, 3, k}, {2, 3, k}}),
                               test::spring_plate(3, 0, {{0, ground, k}, {1, ground, k}, {2, ground, k}}), 300},
                              test::linear_law(K));
  joint.clearance.assign(joint.n_planes(), gap);
  // Plate a has no other hold than its fasteners: it flies through its gaps without load.
  const ExactPath path = exact_path(make_equations(joint), 1);
  ASSERT_EQ(path.pieces.size(), 1U);
  const JointEquations equations = make_equations(joint);
  const auto state = contact_state(equations, path.at(1));
  for (const double F : state.F) EXPECT_NEAR(F, 100, 1e-10);
  for (const double delta : state.delta) EXPECT_NEAR(delta, gap + 100 / K, 1e-13);

  // With a hold of its own it needs a load: P* = k_hold gap, shared evenly beyond.
  constexpr double hold = 200;
  joint.plates[0] =
      make_plate("a", "a.h5", test::spring_plate(3, 1, {{0, 3, k}, {1, 3, k}, {2, 3, k}, {3, ground, hold}}), 8);
  joint.force[{0, 0}] = 300;
  const ExactPath held = exact_path(make_equations(joint), 1);
  ASSERT_EQ(held.pieces.size(), 2U) << "three corners at one load factor";
  EXPECT_NEAR(300 * held.pieces[0].end, hold * gap, 1e-12 * 300);
}

TEST(ExactPath, PlasticFastenersMoveTheirLoadToTheNeighbour) {
  // Rigid sheets, two fasteners of stiffness K, the first yields at F_y without hardening, the second at none: elastic
  // up to 2 F_y; beyond the second alone takes more.
  constexpr double rigid = 1e9, K = 1000, F_y = 20;
  const auto plastic =
      read_law(input::Value(input::parse("law", R"({"type": "bilinear", "k": 1000, "F_yield": 20, "k_yield": 0})")));
  auto joint = test::joint_of({test::spring_plate(2, 1, {{0, 2, rigid}, {1, 2, rigid}}),
                               test::spring_plate(2, 0, {{0, ground, rigid}, {1, ground, rigid}}), 100},
                              test::linear_law(K));
  joint.law[0] = plastic;
  const JointEquations equations = make_equations(joint);
  const ExactPath path = exact_path(equations, 1);
  ASSERT_EQ(path.pieces.size(), 2U);
  EXPECT_NEAR(100 * path.pieces[0].end, 2 * F_y, 1e-3) << "to K / rigid";
  const VectorXd F = contact_state(equations, path.at(1)).F;
  EXPECT_NEAR(F[0], F_y, 1e-9);
  EXPECT_NEAR(F[1], 100 - F_y, 1e-6);
}

TEST(ExactPath, EndsAtTheLoadThatPlasticFastenersCannotCarry) {
  const auto plastic =
      read_law(input::Value(input::parse("law", R"({"type": "bilinear", "k": 1000, "F_yield": 20, "k_yield": 0})")));
  const JointEquations equations = make_equations(test::joint_of(test::two_fastener_lap(), plastic));
  const ExactPath path = exact_path(equations, 1);
  EXPECT_NEAR(100 * path.reach(), 2 * 20, 1e-10);
  const LoadPath path_of_solvers = follow(equations, {0.3, 0.5}, {});
  ASSERT_TRUE(path_of_solvers.failure);
  ASSERT_EQ(path_of_solvers.steps.size(), 1U);
  EXPECT_EQ(path_of_solvers.failure->load_factor, 0.5);
}

TEST(ExactPath, IsTheSameInAnyUnitOfForce) {
  // A fastener that yields beside a loose one, in newtons and in units of 1e20 N and of 1e-20 N.
  const auto solved = [](double unit) {
    auto joint =
        test::joint_of({test::chain(2, 1, 1000 * unit, {{1, 2, 1000 * unit}}),
                        test::chain(2, 0, 1000 * unit, {{0, ground, 1000 * unit}}), 100 * unit},
                       read_law(input::Value(input::parse(
                           "law", fmt::format(R"({{"type": "bilinear", "k": {}, "F_yield": {}, "k_yield": {}}})",
                                              2000 * unit, 30 * unit, 50 * unit)))));
    joint.clearance[1] = 0.01;
    const JointEquations equations = make_equations(joint);
    const ExactPath path = exact_path(equations, 1);
    EXPECT_EQ(path.pieces.size(), 4U) << unit;
    EXPECT_LT(residual(equations, path, 1), 1e-14) << unit;
    return VectorXd(path.at(1) / unit);
  };
  const VectorXd newtons = solved(1);
  for (const double unit : {1e-20, 1e20}) EXPECT_TRUE(solved(unit).isApprox(newtons, 1e-13)) << unit;
}

/// Against the nonlinear solvers at random load factors, also reversed, and at the corners themselves.
class RandomPaths : public testing::TestWithParam<test::RandomJoint> {};

TEST_P(RandomPaths, EqualWhatTheSolversFind) {
  std::mt19937 random(81);
  int corners = 0;
  constexpr int joints = 300;
  for (int i = 0; i < joints; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, GetParam()));
    const bool one_way = GetParam().one_sided && GetParam().floating;
    std::vector<ExactPath> paths{exact_path(equations, 1)};
    if (!one_way) paths.push_back(exact_path(equations, -1));
    for (const auto& path : paths) {
      corners += static_cast<int>(path.pieces.size()) - 1;
      EXPECT_EQ(path.reach(), 1) << "joint " << i;
      for (const auto& piece : path.pieces)
        EXPECT_LE(residual(equations, path, path.sign * piece.end), 1e-12) << "joint " << i << " at " << piece.end;
      std::vector<double> factors;
      for (int k = 0; k < 3; ++k)
        factors.push_back(path.sign * path.reach() * std::uniform_real_distribution<double>(0.01, 1)(random));
      const LoadPath solved = follow(equations, factors, test::tight);
      EXPECT_FALSE(solved.failure) << "joint " << i;
      for (const auto& step : solved.steps) {
        const auto state = contact_state(equations, path.at(step.load_factor));
        const double scale = force_scale(equations, 1);
        EXPECT_LT((state.F - step.F).cwiseAbs().maxCoeff(), 1e-9 * scale) << "joint " << i;
      }
    }
  }
  EXPECT_GT(corners, joints);
}

INSTANTIATE_TEST_SUITE_P(
    Of, RandomPaths,
    testing::Values(test::RandomJoint{.piecewise = true}, test::RandomJoint{.clearances = false, .piecewise = true},
                    test::RandomJoint{.friction = true, .piecewise = true},
                    test::RandomJoint{.one_sided = true, .piecewise = true},
                    test::RandomJoint{.floating = true, .piecewise = true},
                    test::RandomJoint{.friction = true, .one_sided = true, .floating = true, .piecewise = true}));

/// Three plates with friction on the middle one too, whose rims two planes fraction: their sides are corners of their
/// own.
TEST(ExactPath, OfStacksEqualsWhatTheSolversFind) {
  std::mt19937 random(83);
  for (int i = 0; i < test::scenes(100); ++i) {
    auto laws = test::random_joint(random, {.piecewise = true});
    const int n = static_cast<int>(laws.planes.size());
    test::Lap lap{test::chain(n, 1, 1e4, {{n - 1, n, 1e4}, {0, ground, 1e3}}),
                  test::chain(n, 0, 2e4, {{0, ground, 2e4}}), 1000};
    test::add_friction(lap.a, random);
    test::add_friction(lap.b, random);
    auto joint = test::joint_of(lap, test::linear_law(1));
    joint.plates.push_back(make_plate("c", "c.h5", lap.a, 8));
    joint.force[{2, 0}] = std::uniform_real_distribution<double>(-1000, 1000)(random);
    joint.remove_fasteners();
    for (int j = 0; j < n; ++j) {
      const Index at = j;
      test::add_fastener(joint, {{0, j}, {1, j}, {2, j}}, laws.law[at]);
      joint.clearance[2 * at] = laws.clearance[at];
      joint.law[2 * at + 1] = laws.law[n - 1 - j];
      test::set_friction(joint, at, 0.2);
    }
    const JointEquations equations = make_equations(joint);
    EXPECT_EQ(PiecewiseJoint(equations).shared_rims().size(), n);
    for (const double sign : {1.0, -1.0}) {
      const ExactPath path = exact_path(equations, sign);
      ASSERT_EQ(path.reach(), 1) << "joint " << i;
      for (const auto& piece : path.pieces) EXPECT_LE(residual(equations, path, sign * piece.end), 1e-12);
      const LoadPath solved = follow(equations, {0.3 * sign, 0.7 * sign, sign}, test::tight);
      EXPECT_FALSE(solved.failure) << "joint " << i;
      for (const auto& step : solved.steps) {
        const auto state = contact_state(equations, path.at(step.load_factor));
        EXPECT_LT((state.F - step.F).cwiseAbs().maxCoeff(), 1e-9 * force_scale(equations, 1)) << "joint " << i;
      }
    }
  }
}

/// R of the sign that makes a joint lock itself, which those of random_joint() never do (mu < 0 turns it): where the
/// path goes to the end it is a solution, where it turns back it ends, and the solvers may still find one.
TEST(ExactPath, EndsWhereFrictionTurnsItBack) {
  int turned = 0, went_on = 0;
  for (const double mu : {0.5, 1.0, 2.0, 4.0}) {
    std::mt19937 random(82);
    int ended = 0;
    for (int i = 0; i < test::scenes(100); ++i) {
      auto joint = test::random_joint(random, {.friction = true, .piecewise = true});
      for (Index j = 0; j < std::ssize(joint.fasteners); ++j) test::set_friction(joint, j, -mu);
      const JointEquations equations = make_equations(joint);
      const ExactPath path = exact_path(equations, 1);
      for (const auto& piece : path.pieces) EXPECT_LE(residual(equations, path, piece.end), 1e-11) << "joint " << i;
      if (path.reach() == 1) continue;
      ++ended;
      const LoadPath solved = follow(equations, {0.999 * path.reach(), 1}, {});
      ASSERT_FALSE(solved.steps.empty()) << "joint " << i;
      if (solved.failure) continue;
      EXPECT_LE(solved.steps[1].residual, 1e-10);
      ++went_on;
    }
    turned += ended;
  }
  EXPECT_GT(turned, 0);
  EXPECT_GT(went_on, 0);
}

}  // namespace
}  // namespace fastjoint::stage3::exact_path_test
