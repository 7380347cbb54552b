// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/rim_gap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fastjoint::stage1 {
namespace {

using std::numbers::pi;

void expect_arcs(const Arcs& found, const Arcs& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].from, expected[i].from, 1e-8) << i;
    EXPECT_NEAR(found[i].to, expected[i].to, 1e-8) << i;
  }
}

TEST(SprungArcs, PiecesThatTouchAreOneArc) {
  expect_arcs(joined({{0.5, 1}, {0, 0.5}, {2, 2.5}}), {{0, 1}, {2, 2.5}});
  expect_arcs(joined({{pi - 0.5, pi}, {-pi, -pi + 0.25}, {0, 1}}), {{0, 1}, {pi - 0.5, pi + 0.25}});
  expect_arcs(joined({{pi - 0.5, pi}, {pi, pi + 0.25}}), {{pi - 0.5, pi + 0.25}});
  expect_arcs(joined({{0, pi}, {pi, 2 * pi}}), {{-pi, pi}});
  expect_arcs(joined({{pi, pi + 1}}), {{-pi, -pi + 1}});
  expect_arcs(joined({}), {});
}

TEST(SprungArcs, MoveIsThatOfTheFarthestEnd) {
  EXPECT_NEAR(largest_move({{0, 1}, {2, 3}}, {{0.01, 1}, {2, 3.02}}), 0.02, 1e-15);
  EXPECT_NEAR(largest_move({{pi - 0.001, pi + 1}}, {{-pi, -pi + 1}}), 0.001, 1e-12);  // over pi
  EXPECT_EQ(largest_move({}, {}), 0);
  EXPECT_TRUE(std::isinf(largest_move({{0, 1}}, {})));
  EXPECT_GT(largest_move({{-pi, pi}}, {{pi / 2, pi}}), 1);
}

}  // namespace
}  // namespace fastjoint::stage1
