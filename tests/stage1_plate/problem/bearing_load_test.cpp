// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <numbers>

#include "common/errors.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::bearing_load_test {
namespace {

using testing::HasSubstr;

const std::string held = R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])";
const test::HoleText open = {"o", 1.5, 0.5, 0.2, 0, false};

std::string pin(const std::string& hole, const std::string& direction) {
  return held + R"(, "external": [{"id": "T", "on": "top", "direction": "y", "kind": "traction"},
    {"id": "pin", "on": ")" +
         hole + R"(", "direction": ")" + direction + R"(", "kind": "bearing"}])";
}

/// Sum of the loads on the vertices along a component: their work on a unit translation.
double resultant(const test::Plate& plate, int column, int component) {
  const Eigen::VectorXd load = plate.problem.T_f.col(column);
  double sum = 0;
  for (int node = 0; node < plate.mesh.mesh.n_nodes(); ++node)
    if (const int dof = plate.problem.unknowns.dofs(component, node); pfem::is_free(dof)) sum += load[dof];
  return sum;
}

TEST(BearingLoad, HasUnitForceAlongItsDirection) {
  for (const std::string direction : {"x", "y"}) {
    const auto plate = test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {open}, pin("o", direction)));
    const int along = direction == "x" ? 0 : 1;
    for (const int side : {1, 2}) {
      EXPECT_NEAR(resultant(plate, side, along), 1, 1e-13);
      EXPECT_NEAR(resultant(plate, side, 1 - along), 0, 1e-13);
    }
  }
}

/// A pressure cos(theta)/c without friction: int p0 cos theta dA over the bearing half, c = t d pi / 4.
TEST(BearingLoad, ItsConstantIsThatOfACosine) {
  const auto plate = test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {open}, held));
  const double c =
      rim::bearing(plate.mesh.mesh, plate.mesh.edges, plate.mesh.rims[0], Eigen::Vector2d::UnitX()).unit_force;
  EXPECT_NEAR(c / (0.1 * 0.4 * std::numbers::pi / 4), 1, 1e-13);
}

TEST(BearingLoad, IsAColumnOfTheTractions) {
  const auto solution = test::solve(test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {open}, pin("o", "x"))));
  EXPECT_EQ(solution.traction_id, (std::vector<std::string>{"T", "pin", "pin"}));
  EXPECT_EQ(solution.traction_hole, (std::vector<std::string>{"", "o", "o"}));
  EXPECT_EQ(solution.traction_bearing, (std::vector<std::string>{"", "+x", "-x"}));
  EXPECT_EQ(solution.traction_direction, (std::vector<std::string>{"y", "x", "x"}));
  EXPECT_EQ(solution.cases.back().T.cols(), 3);
}

TEST(BearingLoad, HalfAHoleTakesItWhole) {
  const auto plate =
      test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"o", 1.5, 0, 0.2, 0, false}},
                                        R"(, "supports": [{"on": "bottom", "fix": ["y"]}, {"on": "left", "fix": ["x"]}],
      "external": [{"id": "pin", "on": "o", "direction": "x", "kind": "bearing"}])"));
  EXPECT_NEAR(resultant(plate, 0, 0), 1, 1e-13);
}

TEST(BearingLoad, OfHalfAHoleHasOneSideIfItsLineIsAcross) {
  const auto load = [](const std::string& direction) {
    return R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
      "external": [{"id": "pin", "on": "o", "direction": ")" +
           direction + R"(", "kind": "bearing"}])";
  };
  const test::HoleText half = {"o", 0, 0.5, 0.2, 0, false};
  for (const auto& [direction, sides] : {std::pair("x", 1), std::pair("y", 2)})
    EXPECT_EQ(test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {half}, load(direction))).problem.T_f.cols(), sides);
}

TEST(BearingLoad, WhereItCannotAct) {
  const auto message = [](const std::string& json) -> std::string {
    try {
      (void)test::make_plate(json);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(
      message(test::grid_scene({0, 1, 2}, {0, 1}, {open, {"s", 0.5, 0.5, 0.2}}, pin("s", "x"))),
      HasSubstr("plate.json: /external/1/on: hole \"s\" has springs, which transmit its load; allowed: a hole"));
  EXPECT_THAT(message(test::grid_scene({0, 1, 2}, {0, 1}, {open}, pin("right", "x"))),
              HasSubstr("/external/1/on: \"right\" is not allowed; allowed: \"o\""));
  EXPECT_THAT(message(test::grid_scene({0, 1, 2}, {0, 1}, {{"o", 1.5, 1, 0.2, 0, false}}, pin("o", "y"))),
              HasSubstr("/external/1: the model has no rim of hole \"o\" on the side that bears along +y"));
}

}  // namespace
}  // namespace fastjoint::bearing_load_test
