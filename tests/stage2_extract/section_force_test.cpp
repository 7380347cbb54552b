// SPDX-License-Identifier: GPL-3.0-or-later
// Forces over the sections beside holes: what comes in, goes out or goes into the fastener.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using Eigen::Index;

/// A strip one hole wide: no force leaves over its free edges.
std::string strip(const std::string& more = "") {
  return test::grid_scene({0, 1, 2, 3.5}, {0, 0.8}, {{"a", 0.5, 0.4, 0.1, 1}, {"b", 1.5, 0.4, 0.12, 1}},
                          fmt::format(R"(, "supports": [{{"on": "bottom", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}}]{})",
                                      more));
}

TEST(SectionForce, IsInEquilibriumWithFastenersAndExternal) {
  const auto a = test::extract(strip()).matrices;
  const auto& s = a.stresses;
  ASSERT_EQ(s.section_hole, (std::vector<std::string>{"a", "a", "b", "b"}));
  ASSERT_EQ(s.section_side, (std::vector<std::string>{"+x", "-x", "+x", "-x"}));
  const auto& N = s.section_force.back();
  const double largest = a.S_dd.back().cwiseAbs().maxCoeff();
  constexpr double accuracy = 1e-4;  // integrated stresses converge at half the rate of S
  for (Index c = 0; c < 3; ++c) {
    const auto force = [&](Index disc) { return c == 0 ? a.S_ed.back()(0, disc) : a.S_dd.back()(disc, c - 1); };
    const double P = c == 0 ? a.S_ee.back()(0, 0) : a.S_ed.back()(0, c - 1);
    EXPECT_NEAR(N(1, c), 0, accuracy * largest) << "the free end";
    EXPECT_NEAR(N(1, c) - N(0, c), force(0), accuracy * largest);
    EXPECT_NEAR(N(3, c) - N(2, c), force(1), accuracy * largest);
    EXPECT_NEAR(N(2, c), P, accuracy * largest);
    EXPECT_NEAR(N(0, c), N(3, c), 1e-12 * largest) << "one section, seen from two holes";
  }
  const Index friction = 3;  // hole a, +x
  const double largest_R = a.R_df.back().cwiseAbs().maxCoeff();
  EXPECT_NEAR(N(1, friction) - N(0, friction), a.friction_resultant[0] + a.R_df.back()(0, 0), accuracy * largest_R);
}

TEST(SectionForce, ConvergesWithTheDegree) {
  const auto error = [](int p) {
    const auto a = test::extract(strip(fmt::format(R"(, "p": [{}, {}])", p, p))).matrices;
    const Eigen::RowVectorXd discs = a.stresses.section_force[0].row(2).segment(1, 2) - a.S_ed[0];
    return std::max(std::abs(a.stresses.section_force[0](2, 0) - a.S_ee[0](0, 0)), discs.cwiseAbs().maxCoeff());
  };
  EXPECT_LT(error(4), 0.3 * error(2));
  EXPECT_LT(error(6), 0.3 * error(4));
  EXPECT_LT(error(8), 0.3 * error(6));
}

TEST(SectionForce, AreasAreThoseOfTheCell) {
  const auto s = test::extract(strip()).matrices.stresses;
  EXPECT_NEAR(s.gross_area[0], 0.08, 1e-14);
  EXPECT_NEAR(s.net_area[0], 0.08 - 0.02, 1e-12);
  EXPECT_NEAR(s.net_area[2], 0.08 - 0.024, 1e-12);
}

/// On a line of symmetry through the hole there is no section on that side.
TEST(SectionForce, NoneWhereTheCutIsTheBorderThroughTheHole) {
  const auto s =
      test::extract(test::grid_scene({0, 1}, {0, 0.5}, {{"q", 0, 0, 0.1}},
                                     R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}], "disc_directions": ["x", "y"])"))
          .matrices.stresses;
  EXPECT_EQ(s.section_side, (std::vector<std::string>{"+x", "+y"}));
}

}  // namespace
}  // namespace fastjoint
