// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/exact_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "stage3_nonlinear/path/load_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::ground;

/// A row of n fasteners that yield, between equal sheets, three of four loose; plate a has no other hold but a spring.
JointEquations row_of(int n, double friction, double spring = 0) {
  std::mt19937 random(7);
  constexpr double k = 1e5;
  test::Lap lap{test::chain(n, 1, k, {{n - 1, n, k}, {0, ground, spring}}), test::chain(n, 0, k, {{0, ground, k}}),
                1000.0 * n};
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  auto joint = test::joint_of(lap, test::bilinear_law(2e4, 900, 4e3));
  for (Index j = 0; j < std::ssize(joint.planes); ++j) {
    if (j % 4 != 0) joint.planes[j].clearance = std::uniform_real_distribution<double>(0.001, 0.1)(random);
    if (friction > 0) test::set_friction(joint, j, friction);
  }
  return make_equations(joint);
}

class RowOfFasteners : public testing::TestWithParam<double> {};

TEST_P(RowOfFasteners, HasInHundredsOfCellsTheLineOfTheirOwnFactor) {
  constexpr int n = 160, n_cells = 400;
  const JointEquations equations = row_of(n, GetParam());
  const PiecewiseJoint joint(equations);
  for (const auto& [moving, most_factors] : {std::pair(n / 8, 1), std::pair(n, 8 * n_cells / n + 1)}) {
    CellLines lines(joint, equations.system.q);
    Cell cell = joint.start();
    (void)lines.in(cell);
    std::mt19937 random(3);
    for (int i = 0; i < n_cells; ++i) {
      const int plane = std::uniform_int_distribution<int>(0, moving - 1)(random);
      auto& piece = cell.piece[plane];
      piece = piece + 1 < std::ssize(joint.curve(plane).pieces) ? piece + 1 : piece - 1;
      joint.follow_signs(cell);
      const auto line = lines.in(cell), own = CellLines(joint, equations.system.q).in(cell);
      ASSERT_TRUE(line && own) << i;
      ASSERT_LT((line->rate - own->rate).norm(), 1e-10 * own->rate.norm()) << i;
      ASSERT_LT((line->offset - own->offset).norm(), 1e-10 * own->offset.norm()) << i;
    }
    EXPECT_LE(lines.n_factors(), most_factors) << "one for an eighth of the columns";
  }
}

TEST_P(RowOfFasteners, HasThePathThatTheSolversFind) {
  const JointEquations equations = row_of(160, GetParam());
  const LoadPath exact = follow(equations, {0.3, 1}, {});
  const LoadPath solved = test::follow_nonlinear(equations, {0.3, 1}, {{}, {.tolerance = 1e-13}});
  ASSERT_FALSE(exact.failure || solved.failure);
  for (const Index i : {0, 1}) {
    EXPECT_TRUE(exact.steps[i].exact && !solved.steps[i].exact);
    EXPECT_GT(exact.steps[i].iterations, 20) << "pieces, which one factor for 20 columns serves";
    EXPECT_LT((exact.steps[i].F - solved.steps[i].F).norm(), 1e-10 * solved.steps[i].F.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Friction, RowOfFasteners, testing::Values(0.0, 0.2));

TEST(CellLines, AreNoneWhereNothingHoldsAPlateThoughTheNeighbourCellIsHeld) {
  JointEquations equations = row_of(40, 0);
  for (Contact& contact : equations.contacts) contact.clearance = 0.1;
  const PiecewiseJoint joint(equations);
  CellLines lines(joint, equations.system.q);
  const Cell free = joint.start();
  EXPECT_FALSE(lines.in(free)) << "by its own factor";
  for (int j = 0; j + 1 < 40; ++j) {
    Cell held = free;
    ++held.piece[j];
    ++held.piece[j + 1];
    EXPECT_TRUE(lines.in(held));
    EXPECT_FALSE(lines.in(free)) << "by that of the other cell";
  }
}

/// From a cell in which a plate hangs on a soft spring the formula loses digits: the line must balance, or else the
/// cell's own matrix is factorised.
TEST(CellLines, AreThoseOfTheirOwnFactorThoughTheNeighbourCellIsHardlyHeld) {
  int n_factors = 0;
  for (double spring = 1e5; spring > 1e-2; spring /= 10) {
    JointEquations equations = row_of(40, 0, spring);
    for (Contact& contact : equations.contacts) contact.clearance = 0.1;
    const PiecewiseJoint joint(equations);
    const Cell free = joint.start();
    for (int j = 0; j < 40; ++j) {
      CellLines lines(joint, equations.system.q);
      ASSERT_TRUE(lines.in(free));
      Cell held = free;
      ++held.piece[j];
      const auto line = lines.in(held), own = CellLines(joint, equations.system.q).in(held);
      ASSERT_TRUE(line && own);
      EXPECT_LT((line->rate - own->rate).norm(), 1e-10 * own->rate.norm()) << spring << ", " << j;
      EXPECT_LT((line->offset - own->offset).norm(), 1e-10 * own->offset.norm()) << spring << ", " << j;
      n_factors += lines.n_factors();
    }
  }
  EXPECT_GT(n_factors, 8 * 40) << "some by their own factor";
}

}  // namespace
}  // namespace fastjoint::stage3
