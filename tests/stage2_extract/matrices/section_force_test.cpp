// SPDX-License-Identifier: GPL-3.0-or-later
// Forces over the sections beside holes: what comes in, goes out or goes into the fastener.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using Eigen::Index;

/// A strip one hole wide: no force leaves over its free edges.
std::string strip(const std::string& more = "") {
  return test::grid_scene({0, 1, 2, 3.5}, {0, 0.8}, {{"a", 0.5, 0.4, 0.1, 1}, {"b", 1.5, 0.4, 0.12, 1}},
                          fmt::format(R"(, "space": "trunk", "supports": [{{"on": "bottom", "fix": ["y"]}}],
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

/// The strip with hole a alone, in ten elements numbered unlike the grid's: a fan of eight and two rectangles.
std::string strip_by_hand(const std::string& right_cut) {
  const double length = std::hypot(0.5, 0.4);
  const double dx = 0.1 * 0.5 / length, dy = 0.1 * 0.4 / length;  // to the rim on the ray to a corner of the cell
  std::string arcs;
  for (int i = 0; i < 8; ++i)
    arcs += fmt::format(R"({}{{"edge": [{}, {}], "center": [0.5, 0.4]}})", i ? ", " : "", 11 + i, 11 + (i + 1) % 8);
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"mesh": {{
      "nodes": [[2, 0], [2, 0.4], [2, 0.8], [1, 0.8], [1, 0.4], [1, 0], [0.5, 0], [0, 0], [0, 0.4], [0, 0.8], [0.5, 0.8],
                [{1:.17g}, {2:.17g}], [0.6, 0.4], [{1:.17g}, {3:.17g}], [0.5, 0.5],
                [{0:.17g}, {3:.17g}], [0.4, 0.4], [{0:.17g}, {2:.17g}], [0.5, 0.3]],
      "quads": [[4, 1, 2, 3], [1, 4, 5, 0], [6, 5, 11, 18], [11, 5, 4, 12], [4, 3, 13, 12], [3, 10, 14, 13],
                [10, 9, 15, 14], [9, 8, 16, 15], [16, 8, 7, 17], [7, 6, 18, 17]],
      "arcs": [{4}], "thickness": 0.1,
      "edges": {{"right": [[0, 1], [2, 1]], "bottom": [[0, 5], [5, 6], [6, 7]]}},
      "sections": [{{"hole": "a", "side": "+x", "edges": [{5}]}},
                   {{"hole": "a", "side": "-x", "edges": [[7, 8], [8, 9]]}}]}}}},
    "holes": [{{"id": "a", "center": [0.5, 0.4], "radius": 0.1, "spring": {{"disk": {{"E": 1e7, "nu": 0.3}}}}}}],
    "supports": [{{"on": "bottom", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}}]}})",
                     0.5 - dx, 0.5 + dx, 0.4 - dy, 0.4 + dy, arcs, right_cut);
}

TEST(SectionForce, OfAMeshOfItsOwnAreThoseOfTheGridWithTheSameMesh) {
  const auto grid = test::extract(test::grid_scene({0, 1, 2}, {0, 0.8}, {{"a", 0.5, 0.4, 0.1}},
                                                   R"(, "supports": [{"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"));
  const auto mesh = test::extract(strip_by_hand("[3, 4], [5, 4]"));
  const auto& expected = grid.matrices.stresses;
  const auto& found = mesh.matrices.stresses;
  ASSERT_EQ(mesh.matrices.ndof, grid.matrices.ndof);
  EXPECT_EQ(found.section_hole, expected.section_hole);
  EXPECT_EQ(found.section_side, expected.section_side);
  EXPECT_LT((found.gross_area - expected.gross_area).norm(), 1e-14);
  EXPECT_LT((found.net_area - expected.net_area).norm(), 1e-12);
  ASSERT_EQ(found.section_force.size(), expected.section_force.size());
  constexpr double round_off = 1e-9;  // of the largest force: another order of elements and unknowns
  for (std::size_t level = 0; level < expected.section_force.size(); ++level) {
    const auto& N = expected.section_force[level];
    ASSERT_EQ(N.rows(), 2);
    for (Index c = 0; c < N.cols(); ++c)
      EXPECT_LT((found.section_force[level].col(c) - N.col(c)).norm(), round_off * N.col(c).norm()) << "case " << c;
  }
}

/// What crosses the strip beside the hole leaves it at its end: a border has elements on one side only.
TEST(SectionForce, OnTheBorderIsThatOfTheExternal) {
  const auto a = test::extract(strip_by_hand("[1, 0], [1, 2]")).matrices;
  EXPECT_NEAR(a.stresses.section_force.back()(0, 0), a.S_ee.back()(0, 0), 2e-3 * a.S_ee.back()(0, 0));
}

/// A side on a line of symmetry through the hole has no section.
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
