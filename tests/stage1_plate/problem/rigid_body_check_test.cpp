// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::rigid_body_check_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAre;

std::string message(const std::string& json) {
  const test::Plate plate = test::make_plate(json);
  try {
    stage1::check_rigid_motions(plate.scene, plate.mesh, plate.problem.unknowns);
  } catch (const NumericalError& e) {
    return e.what();
  }
  return "held";
}

std::string square(const std::vector<test::HoleText>& holes, const std::string& extra) {
  return test::grid_scene({0, 1, 2}, {0, 1}, holes, extra);
}
const test::HoleText first = {"a", 0.5, 0.5, 0.2};
const test::HoleText second = {"b", 1.5, 0.5, 0.2};
const test::HoleText open = {"c", 1.5, 0.5, 0.2, 0, false};

TEST(Holding, SupportsSpringsAndExternalsHold) {
  EXPECT_EQ(message(square({}, R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])")), "held");
  EXPECT_EQ(message(square({first, second}, "")), "held");  // a sheet that only its fasteners hold
  EXPECT_EQ(
      message(square({first}, R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])")),
      "held");
}

TEST(Holding, TheFreeMotionIsNamed) {
  EXPECT_THAT(message(square({}, R"(, "supports": [{"on": "bottom", "fix": ["y"]}])")),
              AllOf(StartsWith("plate.json: /supports: the plate is free to move along x"), HasSubstr("allowed:")));
  EXPECT_THAT(message(square({}, R"(, "supports": [{"on": "left", "fix": ["x"]}])")),
              HasSubstr("free to move along y"));
  EXPECT_THAT(message(square({first, open}, "")), HasSubstr("free to move by rotation about (0.5, 0.5)"));
}

std::vector<std::string> missing(const std::string& json) {
  const test::Plate plate = test::make_plate(json);
  return stage1::missing_symmetry(plate.scene, plate.mesh, plate.problem.unknowns);
}

/// Only a support that fixes the line of a half hole across itself makes it a line of symmetry.
TEST(Holding, ALineOfSymmetryWithoutSupportIsNamed) {
  const test::HoleText half = {"half", 0.5, 0, 0.2}, other = {"other", 1.5, 0, 0.2}, whole = {"whole", 1.5, 0.5, 0.2};
  const auto on = [](const std::string& supports) {
    return R"(, "disc_directions": ["x", "y"], "supports": [)" + supports + "]";
  };
  const std::string left = R"({"on": "left", "fix": ["x", "y"]})", bottom = R"({"on": "bottom", "fix": ["y"]})";
  using testing::ElementsAre;
  EXPECT_THAT(
      missing(square({half, other}, on(left))),
      ElementsAre(AllOf(HasSubstr("/holes/0: hole \"half\" (and 1 more) is half of a hole"),
                        HasSubstr("the line y = 0, which no support fixes along y"), HasSubstr("add " + bottom))));
  EXPECT_THAT(missing(square({half, other}, on(left + "," + bottom))), ElementsAre());
  EXPECT_THAT(missing(square({half}, on(R"({"on": "bottom", "fix": ["x"]})"))), ElementsAre(HasSubstr(bottom)));
  EXPECT_THAT(missing(square({whole}, on(left))), ElementsAre());
  EXPECT_THAT(missing(square({{"notch", 0.5, 0, 0.2, 0, false}}, on(left))), ElementsAre()) << "an open hole";
  EXPECT_THAT(missing(square({half}, R"(, "disc_directions": ["y"])")), ElementsAre()) << "a pin presses on a notch";
  EXPECT_THAT(
      missing(square({half}, R"(, "external": [{"id": "P", "on": "bottom", "direction": "y", "kind": "rigid"}])")),
      ElementsAre());
  const test::HoleText quarter = {"q", 2, 1, 0.2};
  EXPECT_THAT(missing(square({quarter}, on(left))),
              UnorderedElementsAre(AllOf(HasSubstr("a quarter of a hole"), HasSubstr(R"({"on": "top", "fix": ["y"]})")),
                                   AllOf(HasSubstr("x = 2"), HasSubstr(R"({"on": "right", "fix": ["x"]})"))));
  EXPECT_THAT(message(square({half}, on(""))),
              AllOf(HasSubstr("by rotation about (0.5, "), HasSubstr("add " + bottom)));
}

TEST(Holding, EveryPartMustBeHeld) {
  const std::string two = R"({"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {"al": {"E": 1e7, "nu": 0.3}},
    "geometry": {"mesh": {"nodes": [[0,0],[1,0],[1,1],[0,1],[5,0],[6,0],[6,1],[5,1]], "quads": [[0,1,2,3],[4,5,6,7]],
    "thickness": 1, "edges": {"left": [[3, 0]]}}}, "supports": [{"on": "left", "fix": ["x", "y"]}]})";
  EXPECT_THAT(message(two), HasSubstr("the part of the plate around (5.5, 0.5) is free to move"));
}

}  // namespace
}  // namespace fastjoint::rigid_body_check_test
