// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that fall: laws have no memory, so forces go back the way they came.
#include <gtest/gtest.h>

#include "stage3_nonlinear/path/load_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3::unloading_test {
namespace {

const std::vector<double> factors{0.4, 1, 0.4, 0, -0.4};

/// Without friction a joint's forces are unique; laws are odd.
TEST(Unloading, BringsForcesBackTheWayTheyCame) {
  std::mt19937 random(11);
  int bent = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto joint = test::random_joint(random, {.cubics = trial % 3 == 0, .piecewise = trial % 2 == 1});
    const auto equations = make_equations(joint);
    for (const auto& path : {follow(equations, factors, test::tight), follow(equations, factors, test::tight)}) {
      ASSERT_FALSE(path.failure) << trial;
      ASSERT_EQ(path.steps.size(), factors.size()) << trial;
      const auto F = [&](Index step) { return path.steps[step].F; };
      const double rounding = 1e-9 * F(1).cwiseAbs().maxCoeff();
      EXPECT_LT((F(2) - F(0)).cwiseAbs().maxCoeff(), rounding) << trial;
      EXPECT_LT(F(3).cwiseAbs().maxCoeff(), rounding) << trial;
      EXPECT_LT((F(4) + F(0)).cwiseAbs().maxCoeff(), rounding) << trial;
      bent += (F(0) - 0.4 * F(1)).cwiseAbs().maxCoeff() > 1e-3 * F(1).cwiseAbs().maxCoeff();
    }
  }
  EXPECT_GT(bent, 60) << "of 120 paths: most joints are not linear";
}

}  // namespace
}  // namespace fastjoint::stage3::unloading_test
