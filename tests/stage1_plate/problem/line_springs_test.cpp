// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::HasSubstr;

std::string strip(const std::string& extra) { return test::grid_scene({0, 1, 2, 3}, {0, 1}, {}, extra); }

std::string what_is_free(const std::string& json) {
  try {
    const auto plate = test::make_plate(json);
    stage1::check_rigid_motions(plate.scene, plate.mesh, plate.problem.unknowns);
  } catch (const InputError& e) {
    return e.what();
  } catch (const NumericalError& e) {
    return e.what();
  }
  return "held";
}

/// S = K k / (K + k), k the plate's own stiffness at the vertex: the same k from every K.
TEST(LineSprings, SpringAndPlateAreInSeries) {
  const auto plate_stiffness = [](double K) {
    const auto plate = test::make_plate(strip(fmt::format(
        R"(, "supports": [{{"on": "left", "fix": ["x", "y"]}}], "points": [{{"id": "K1", "at": [2, 1], "stiffness": {}}}])",
        K)));
    const auto& a = plate.problem;
    EXPECT_EQ(a.unknowns.disc_hole, (std::vector<std::string>{"K1"}));
    EXPECT_TRUE(a.friction_hole.empty());
    const double S = (a.K_cc + a.K_fc.transpose() * test::unit_fields(a, a.numbering.p))(0, 0);
    return 1 / (1 / S - 1 / K);
  };
  const double k = plate_stiffness(1e5);
  EXPECT_GT(k, 0);
  EXPECT_NEAR(plate_stiffness(7e5) / k, 1, 1e-9);
}

TEST(LineSprings, DiscsComeAfterThoseOfHoles) {
  const auto plate = test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.5, 0.5, 0.2}},
                                                       R"(, "disc_directions": ["x", "y"],
    "points": [{"id": "p", "at": [2, 0], "stiffness": 3}, {"id": "q", "at": [2, 1], "stiffness": 5}])"));
  const auto& unknowns = plate.problem.unknowns;
  EXPECT_EQ(unknowns.disc_hole, (std::vector<std::string>{"a", "a", "p", "p", "q", "q"}));
  using enum rim::Axis;
  EXPECT_EQ(unknowns.disc_direction, (std::vector{x, y, x, y, x, y}));
  EXPECT_EQ(plate.problem.ties[0].disc, 2);
  EXPECT_EQ(plate.problem.ties[2].disc, 4);
}

TEST(LineSprings, AControlledVertexCouplesDiscAndExternal) {
  const auto plate = test::make_plate(strip(
      R"(, "supports": [{"on": "left", "fix": ["x", "y"]}], "points": [{"id": "K1", "at": [3, 1], "stiffness": 7}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"));
  EXPECT_EQ(plate.problem.K_cc(1, 1), 7);
  EXPECT_EQ(plate.problem.K_cc(0, 1), -7);
  EXPECT_EQ(plate.problem.K_cc(1, 0), -7);
  EXPECT_EQ(plate.problem.K_fc.col(1).nonZeros(), 0);
}

TEST(LineSprings, WhereTheyCannotBe) {
  const std::string left = R"(, "supports": [{"on": "left", "fix": ["x"]}])";
  EXPECT_THAT(what_is_free(strip(left + R"(, "points": [{"id": "K1", "at": [1.9, 0.8], "stiffness": 1}])")),
              HasSubstr("plate.json: /points/0/at: (1.9, 0.8) is not a vertex of the mesh; allowed: vertices of the "
                        "mesh; the nearest is (2, 1)"));
  EXPECT_THAT(what_is_free(strip(left + R"(, "points": [{"id": "K1", "at": [0, 1], "stiffness": 1}])")),
              HasSubstr("/points/0/at: a support fixes the vertex along x"));
  EXPECT_THAT(what_is_free(test::grid_scene({0, 1}, {0, 1}, {{"a", 0.5, 0.5, 0.2}},
                                            R"(, "points": [{"id": "a", "at": [0, 1], "stiffness": 1}])")),
              HasSubstr("/points/0/id: \"a\" stands twice"));
}

TEST(LineSprings, TheyHoldThePlate) {
  const std::string both = R"(, "disc_directions": ["x", "y"], "points": [{"id": "K1", "at": [1, 1], "stiffness": 1})";
  EXPECT_THAT(what_is_free(strip(both + "]")), HasSubstr("by rotation about (1, 1)"));
  EXPECT_EQ(what_is_free(strip(both + R"(, {"id": "K2", "at": [2, 1], "stiffness": 1}])")), "held");
}

}  // namespace
}  // namespace fastjoint
