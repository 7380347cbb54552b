// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string message(const std::string& json) {
  const test::Plate plate = test::make_plate(json);
  try {
    stage1::check_held(plate.scene, plate.mesh, plate.problem.unknowns);
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
  EXPECT_THAT(
      message(square({}, R"(, "supports": [{"on": "bottom", "fix": ["y"]}])")),
      AllOf(StartsWith("plate.json: /supports: nothing keeps the plate from moving along x"), HasSubstr("allowed:")));
  EXPECT_THAT(message(square({}, R"(, "supports": [{"on": "left", "fix": ["x"]}])")), HasSubstr("moving along y"));
  EXPECT_THAT(message(square({first, open}, "")), HasSubstr("moving by turning about (0.5, 0.5)"));
}

TEST(Holding, EveryPartMustBeHeld) {
  const std::string two = R"({"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {"al": {"E": 1e7, "nu": 0.3}},
    "geometry": {"mesh": {"nodes": [[0,0],[1,0],[1,1],[0,1],[5,0],[6,0],[6,1],[5,1]], "quads": [[0,1,2,3],[4,5,6,7]],
    "thickness": 1, "edges": {"left": [[3, 0]]}}}, "supports": [{"on": "left", "fix": ["x", "y"]}]})";
  EXPECT_THAT(message(two), HasSubstr("nothing keeps the part of the plate around (5.5, 0.5) from moving"));
}

}  // namespace
}  // namespace fastjoint
