// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "stage1_plate/scene/scene.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::stage1 {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string good = R"({
  "format": "plate", "version": 1, "name": "n", "units": {"length": "in", "force": "lbf"}, "analysis": "plane stress",
  "materials": {"al": {"E": 1e7, "nu": 0.3}, "ply": {"E1": 2e7, "E2": 1e6, "nu12": 0.3, "G12": 7e5, "angle": 45}},
  "geometry": {"grid": {"x": [0, 1, 2], "y": [0, 1], "thickness": [[0.1, 0.2]], "material": [["al", "ply"]]}},
  "holes": [{"id": "1", "center": [0.5, 0.5], "radius": 0.2, "spring": {"disk": {"E": 1e7, "nu": 0.3}}},
            {"id": "2", "center": [1.5, 0.5], "radius": 0.2, "rings": 2, "spring": {"modulus": 5}}],
  "disc_directions": ["x", "y"],
  "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
  "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}, {"id": "T", "on": "top", "direction": "y", "kind": "traction"}],
  "space": "product", "p": [2, 6]})";

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = good;
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string message(const std::string& text) {
  return test::message_of([&] { return read_scene(input::parse("plate.json", text)); });
}

TEST(ReadScene, TakesEveryKey) {
  const PlateScene scene = read_scene(input::parse("plate.json", good));
  EXPECT_EQ(scene.name, "n");
  EXPECT_EQ(scene.units, (Units{"in", "lbf"}));
  const auto& grid = std::get<GridGeometry>(scene.geometry);
  EXPECT_EQ(grid.thickness, Eigen::RowVector2d(0.1, 0.2));
  EXPECT_EQ(grid.material, Eigen::RowVector2i(0, 1));
  EXPECT_NEAR(scene.holes[0].spring->modulus, 2 / 0.7 * 1e7 / 0.4, 1e-6);  // (29)
  EXPECT_EQ(scene.holes[1].spring->modulus, 5);
  EXPECT_EQ(scene.holes[1].rings, 2);
  EXPECT_EQ(scene.disc_directions.size(), 2U);
  EXPECT_EQ(scene.externals[1].kind, ExternalKind::traction);
  EXPECT_EQ(scene.space, pfem::Space::product);
  EXPECT_EQ(std::pair(scene.p_low, scene.p_high), std::pair(2, 6));
}

TEST(ReadScene, TakesTheProductSpaceUnlessTold) {
  const auto space = [](const std::string& text) { return read_scene(input::parse("plate.json", text)).space; };
  EXPECT_EQ(space(replaced("\"space\": \"product\", ", "")), pfem::Space::product);
  EXPECT_EQ(space(replaced("product", "trunk")), pfem::Space::trunk);
}

TEST(ReadScene, RefusesWithThePlaceAndWhatIsAllowed) {
  EXPECT_THAT(message(replaced("\"name\"", "\"nmae\"")),
              HasSubstr("plate.json: /nmae: unknown key; allowed: $schema, format"));
  EXPECT_THAT(message(replaced("\"name\"", "\"loads\"")),
              HasSubstr("plate.json: /loads: unknown key; allowed: \"loads\" in JOINT.json"));
  EXPECT_THAT(message(replaced("\"radius\": 0.2,", "")), HasSubstr("/holes/0: key \"radius\" is missing"));
  EXPECT_THAT(message(replaced("\"radius\": 0.2", "\"radius\": 0")),
              HasSubstr("/holes/0/radius: 0 is not allowed; allowed: a number > 0"));
  for (const auto& [what, by, place] :
       {std::tuple("\"E\": 1e7", "\"E\": 1e50", "/materials/al/E: 1e+50"),
        {"\"G12\": 7e5", "\"G12\": 1e-31", "/materials/ply/G12: 1e-31"},
        {"0.1, 0.2", "0.1, 5e-32", "/geometry/grid/thickness/0/1: "},
        {"\"radius\": 0.2", "\"radius\": 1e99", "/holes/0/radius: 1e+99"},
        {"{\"modulus\": 5}", "{\"links\": 1e31}", "/holes/1/spring/links: 1e+31"},
        {"{\"E\": 1e7, \"nu\": 0.3}}}", "{\"E\": 1e31, \"nu\": 0.3}}}", "/holes/0/spring/disk/E: 1e+31"}})
    EXPECT_THAT(message(replaced(what, by)),
                AllOf(HasSubstr(place), HasSubstr("allowed: 1e-"), HasSubstr("0 to 1e+30")));
  EXPECT_THAT(message(replaced("[0, 1, 2]", "[0, 1, 2e30]")), HasSubstr("allowed: -1e+30 to 1e+30"));
  EXPECT_THAT(message(replaced("[1.5, 0.5]", "[1e300, 0.5]")), HasSubstr("/holes/1/center/0: 1e+300"));
  EXPECT_THAT(message(replaced("\"E\": 1e7", "\"E\": -1e7")), HasSubstr("/materials/al/E: -10000000.0 is not allowed"));
  EXPECT_THAT(message(replaced("\"nu\": 0.3", "\"nu\": 0.51")), HasSubstr("/materials/al/nu"));
  EXPECT_THAT(message(replaced("plane stress", "plane")), HasSubstr("allowed: \"plane stress\", \"plane strain\""));
  EXPECT_THAT(message(replaced("\"product\"", "\"serendipity\"")),
              HasSubstr("/space: \"serendipity\" is not allowed; allowed: \"trunk\", \"product\""));
  EXPECT_THAT(message(replaced("[[0.1, 0.2]]", "[[0.1]]")),
              HasSubstr("/geometry/grid/thickness/0: array of 1; allowed: exactly 2"));
  EXPECT_THAT(message(replaced("[[\"al\", \"ply\"]]", "\"steel\"")),
              HasSubstr("/geometry/grid/material: \"steel\" is not allowed; allowed: \"al\", \"ply\""));
  EXPECT_THAT(message(replaced(", \"material\": [[\"al\", \"ply\"]]", "")),
              HasSubstr("/geometry/grid: key \"material\" is missing"));
  EXPECT_THAT(message(replaced("[0, 1, 2]", "[0, 2, 1]")),
              HasSubstr("/geometry/grid/x/2: 1 is not allowed; allowed: cell lines in ascending order"));
  EXPECT_THAT(message(replaced("\"id\": \"2\"", "\"id\": \"1\"")), HasSubstr("/holes/1/id: \"1\" stands twice"));
  EXPECT_THAT(message(replaced("{\"modulus\": 5}", "{}")),
              HasSubstr("/holes/1/spring: {} is not allowed; allowed: either \"disk\" or \"modulus\" or \"links\""));
  EXPECT_THAT(message(replaced("\"on\": \"left\"", "\"on\": \"rigth\"")),
              HasSubstr("allowed: \"left\", \"right\", \"bottom\", \"top\""));
  EXPECT_THAT(message(replaced("[\"x\", \"y\"]", "[\"x\", \"x\"]")),
              HasSubstr("/disc_directions/1: \"x\" stands twice"));
  EXPECT_THAT(message(replaced("[2, 6]", "[2, 9]")),
              HasSubstr("/p/1: 9 is not allowed; allowed: an integer from 2 to 8"));
  EXPECT_THAT(message(replaced("\"kind\": \"rigid\"", "\"kind\": \"stiff\"")), HasSubstr("/external/0/kind"));
  EXPECT_THAT(message(replaced("\"nu12\": 0.3", "\"nu12\": 4.6")),
              HasSubstr("/materials/ply: these constants give a negative strain energy"));
  EXPECT_THAT(message(replaced("\"angle\": 45", "\"E3\": 1")), HasSubstr("/materials/ply/E3: given in plane stress"));
}

TEST(ReadScene, PlaneStrain) {
  EXPECT_THAT(message(replaced("plane stress", "plane strain")), HasSubstr("/materials/ply: key \"E3\" is missing"));
  const std::string strain = R"({"format": "plate", "version": 1, "analysis": "plane strain",
    "materials": {"m": {"E": 1, "nu": 0.5}}, "geometry": {"grid": {"x": [0, 1], "y": [0, 1], "thickness": 1}}})";
  EXPECT_THAT(message(strain),
              HasSubstr("/materials/m/nu: 0.5 is not allowed; allowed: a number > -1 and < 0.5 in plane strain"));
}

}  // namespace
}  // namespace fastjoint::stage1
