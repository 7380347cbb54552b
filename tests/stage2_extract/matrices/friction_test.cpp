// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/plates.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint::friction_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double t = 0.1, r = 0.2;  // thickness of grid_scene

TEST(Friction, ConstantsOfAWholeHole) {
  const auto m =
      test::extract(
          test::grid_scene({0, 1}, {0, 1}, {{"a", 0.4, 0.55, r}},
                           R"(, "disc_directions": ["x", "y"], "supports": [{"on": "left", "fix": ["x", "y"]}])"))
          .matrices;
  EXPECT_EQ(m.friction_bearing, (std::vector<std::string>{"+x", "-x", "+y", "-y"}));
  for (Eigen::Index j = 0; j < 4; ++j) {
    EXPECT_NEAR(m.friction_unit_force[j], t * 2 * r * pi / 4, 1e-14);
    EXPECT_NEAR(m.friction_resultant[j], (j % 2 == 0 ? 1 : -1) * t * r, 1e-14);
  }
}

/// A half hole on the line of symmetry y = 0 has half of each, along that line alone.
TEST(Friction, ConstantsOfAHalfHole) {
  const auto m =
      test::extract(
          test::grid_scene({0, 1}, {0, 1}, {{"a", 0.4, 0, r}},
                           R"(, "disc_directions": ["x", "y"], "supports": [{"on": "left", "fix": ["x", "y"]}])"))
          .matrices;
  EXPECT_EQ(m.disc_direction, (std::vector<std::string>{"x"}));
  EXPECT_EQ(m.friction_bearing, (std::vector<std::string>{"+x", "-x"}));
  EXPECT_LT((m.friction_unit_force - Eigen::Vector2d::Constant(t * r * pi / 4)).norm(), 1e-14);
  EXPECT_LT((m.friction_resultant - Eigen::Vector2d(t * r / 2, -t * r / 2)).norm(), 1e-14);
}

/// Every friction case solved, against the reciprocity that needs no solve.
TEST(Friction, ReactionsByReciprocityEqualThoseBySolving) {
  const test::Plate plate = test::make_plate(test::panel(2, 1));
  const auto solution = test::solve(plate);
  const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
  const auto& unknowns = plate.problem.unknowns;
  const Eigen::MatrixXd by_solving =
      test::plain_matrices(K_ff, plate.problem, 8)
          .block(0, unknowns.n_controlled(), unknowns.n_controlled(), unknowns.n_friction);
  const Eigen::MatrixXd& R = solution.cases[7].R;
  EXPECT_LT((R - by_solving).norm(), 1e-12 * R.norm());
}

/// A friction load on a rigid boundary is carried by it directly: a half hole on the external itself.
TEST(Friction, LoadOnALoadedBoundaryIsCarriedDirectly) {
  const std::string scene = test::grid_scene({0, 1}, {0, 1}, {{"a", 1, 0.5, r}}, R"(, "disc_directions": ["x", "y"],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])");
  const auto result = test::extract(scene);
  ASSERT_TRUE(result.checks.equilibrium);
  EXPECT_LT(*result.checks.equilibrium, 1e-12);
  EXPECT_LT(*result.checks.reciprocity, 1e-12);
  EXPECT_GT(test::make_plate(scene).problem.L_c.cwiseAbs().maxCoeff(), 1e-4);
}

/// R is as superconvergent as S: at p = 4 it is far closer than the unit fields are.
TEST(Friction, ReactionsConverge) {
  const auto coarse = test::extract(test::panel(1, 1)).matrices;
  const auto fine = test::extract(test::panel(1, 1, 2)).matrices;
  const Eigen::MatrixXd& exact = fine.R_df.back();
  double previous = 1e300;
  for (std::size_t level = 1; level < 8; ++level) {
    const double error = (coarse.R_df[level] - exact).norm() / exact.norm();
    EXPECT_LT(error, previous) << "p=" << level + 1;
    previous = error;
  }
  EXPECT_LT(previous, 1e-4);
}

}  // namespace
}  // namespace fastjoint::friction_test
