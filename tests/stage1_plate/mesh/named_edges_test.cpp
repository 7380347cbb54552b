// SPDX-License-Identifier: GPL-3.0-or-later
// Sections that an explicit mesh names; its sets of edges: explicit_mesh_test.cpp.
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::named_edges_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Holes "a" about (10, 10) and "b" about (40, 10) in fans of five elements on squares of 20, two elements between
/// them (5 and 6), and a last one (12) with a slanted end.
std::string sheet_with(const std::string& sections, const std::string& more = "") {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"mesh": {{
      "nodes": [[0, 0], [20, 0], [20, 10], [20, 20], [0, 20], [7, 6], [13, 6], [15, 10], [13, 14], [7, 14],
                [30, 0], [50, 0], [50, 20], [30, 20], [30, 10], [37, 6], [43, 6], [43, 14], [37, 14], [35, 10],
                [80, 0], [60, 20]],
      "quads": [[0, 1, 6, 5], [1, 2, 7, 6], [2, 3, 8, 7], [3, 4, 9, 8], [4, 0, 5, 9],
                [1, 10, 14, 2], [2, 14, 13, 3],
                [10, 11, 16, 15], [11, 12, 17, 16], [12, 13, 18, 17], [13, 14, 19, 18], [14, 10, 15, 19],
                [11, 20, 21, 12]],
      "arcs": [{{"edge": [5, 6], "center": [10, 10]}}, {{"edge": [6, 7], "center": [10, 10]}},
               {{"edge": [7, 8], "center": [10, 10]}}, {{"edge": [8, 9], "center": [10, 10]}},
               {{"edge": [9, 5], "center": [10, 10]}}, {{"edge": [15, 16], "center": [40, 10]}},
               {{"edge": [16, 17], "center": [40, 10]}}, {{"edge": [17, 18], "center": [40, 10]}},
               {{"edge": [18, 19], "center": [40, 10]}}, {{"edge": [19, 15], "center": [40, 10]}}],
      "thickness": 1, "sections": [{}]}}}},
    "holes": [{{"id": "a", "center": [10, 10], "radius": 5}}, {{"id": "b", "center": [40, 10], "radius": 5}}]{}}})",
                     sections, more);
}

std::string section(const std::string& hole, const std::string& side, const std::string& edges) {
  return fmt::format(R"({{"hole": "{}", "side": "{}", "edges": [{}]}})", hole, side, edges);
}

stage1::PlateMesh mesh(const std::string& json) {
  return stage1::make_mesh(stage1::read_scene(input::parse("plate.json", json)));
}

std::string message(const std::string& json) {
  return test::message_of([&] { return mesh(json); });
}

std::vector<int> elements(const rim::Section& s) {
  std::vector<int> result;
  for (const auto& side : s.sides) result.push_back(side.element);
  return result;
}

TEST(MeshSections, HaveTheElementsOnTheHolesSide) {
  const auto plate =
      mesh(sheet_with(section("a", "+x", "[1, 2], [3, 2]") + "," + section("b", "-x", "[14, 10], [14, 13]")));
  ASSERT_EQ(plate.sections.size(), 2u);
  EXPECT_THAT(elements(plate.sections[0]), ElementsAre(1, 2));
  EXPECT_THAT(elements(plate.sections[1]), ElementsAre(11, 10));
  for (const auto& side : plate.sections[0].sides) {
    const auto nodes = plate.edges.nodes.col(plate.edges.of_element(side.local_edge, side.element));
    EXPECT_EQ(plate.mesh.nodes(0, nodes[0]), 20);
    EXPECT_EQ(plate.mesh.nodes(0, nodes[1]), 20);
  }
}

TEST(MeshSections, MayLieFurtherAwayOrOnTheBorder) {
  const auto plate = mesh(sheet_with(section("a", "+x", "[10, 14], [14, 13]") + "," +
                                     section("b", "-x", "[1, 2], [2, 3]") + "," + section("a", "-x", "[0, 4]")));
  ASSERT_EQ(plate.sections.size(), 3u);
  EXPECT_THAT(elements(plate.sections[0]), ElementsAre(5, 6));
  EXPECT_THAT(elements(plate.sections[1]), ElementsAre(4)) << "the border has one element only";
  EXPECT_THAT(elements(plate.sections[2]), ElementsAre(5, 6));
}

TEST(MeshSections, AreSortedByHole) {
  const auto plate = mesh(sheet_with(section("b", "+x", "[11, 12]") + "," + section("a", "+y", "[3, 4]") + "," +
                                         section("b", "-y", "[10, 11]") + "," + section("a", "-x", "[0, 4]"),
                                     R"(, "disc_directions": ["x", "y"])"));
  std::vector<std::string> names;
  for (const auto& s : plate.sections) names.push_back(fmt::format("{}{}", s.hole, s.side));
  EXPECT_THAT(names, ElementsAre("0+y", "0-x", "1+x", "1-y"));
}

TEST(MeshSections, HolesAndSidesAreChecked) {
  EXPECT_EQ(message(sheet_with("")), "no error");
  EXPECT_THAT(message(sheet_with(section("c", "+x", "[1, 2]"))),
              HasSubstr(R"(/geometry/mesh/sections/0/hole: "c" is not allowed; allowed: "a", "b")"));
  EXPECT_THAT(message(sheet_with(section("a", "x", "[1, 2]"))),
              HasSubstr(R"(/geometry/mesh/sections/0/side: "x" is not allowed; allowed: "+x", "-x", "+y", "-y")"));
  EXPECT_THAT(message(sheet_with(section("a", "+y", "[3, 4]"), R"(, "disc_directions": ["x"])")),
              HasSubstr(R"(sections/0/side: "+y", but "y" is not one of "disc_directions"; allowed: "+x", "-x")"));
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[1, 2]") + "," + section("a", "+x", "[10, 14]"))),
              HasSubstr(R"(/geometry/mesh/sections/1: a second section of hole "a" on its side +x; allowed: one)"));
  EXPECT_THAT(message(R"({"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {"al": {"E": 1e7, "nu": 0.3}}, "geometry": {"mesh": {"nodes": [[0, 0], [1, 0], [1, 1], [0, 1]],
    "quads": [[0, 1, 2, 3]], "thickness": 1, "sections": [{"hole": "a", "side": "+x", "edges": [[1, 2]]}]}}})"),
              HasSubstr("/geometry/mesh/sections/0/hole: the plate has no holes"));
}

TEST(MeshSections, EdgesAreChecked) {
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[1, 22]"))),
              HasSubstr("/geometry/mesh/sections/0/edges/0/1: 22 is not allowed"));
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[1, 3]"))),
              HasSubstr("/geometry/mesh/sections/0/edges/0: nodes 1 and 3 are not joined by an edge of an element"));
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[1, 2], [2, 1]"))),
              HasSubstr("sections/0/edges/1: the edge between nodes 2 and 1 stands twice; allowed: each edge once"));
  EXPECT_THAT(message(sheet_with(section("b", "+x", "[20, 21]"))),
              HasSubstr("sections/0/edges/0: the edge between nodes 20 and 21 is not perpendicular to x: its ends "
                        "differ by 20 in x; allowed: edges perpendicular to x within 1e-09 of their length"));
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[6, 7]"))),
              HasSubstr("the edge between nodes 6 and 7 is an arc; allowed: straight edges"));
  EXPECT_THAT(message(sheet_with(section("a", "+x", "[0, 4]"))),
              HasSubstr("the edge between nodes 0 and 4 is at x = 0; allowed: x >= 15, beyond the rim of hole \"a\" on "
                        "its side +x"));
  EXPECT_THAT(
      message(sheet_with(section("b", "-x", "[11, 12]"))),
      HasSubstr("the edge between nodes 11 and 12 is at x = 50; allowed: x <= 35, beyond the rim of hole \"b\""));
  EXPECT_THAT(message(sheet_with(section("a", "+y", "[7, 2]"), R"(, "disc_directions": ["y"])")),
              HasSubstr("the edge between nodes 7 and 2 is at y = 10; allowed: y >= 15, beyond the rim"));
  EXPECT_THAT(
      message(sheet_with(section("a", "+x", "[1, 2], [14, 13]"))),
      HasSubstr("sections/0/edges/1: the edge between nodes 14 and 13 is at x = 30; allowed: edges on one line; "
                "the first is at x = 20"));
}

TEST(MeshSections, AreWiderThanTheirHole) {
  EXPECT_THAT(
      message(sheet_with(section("a", "+x", "[1, 2]"))),
      HasSubstr("/geometry/mesh/sections: the section of hole \"a\" on its side +x has an area of 10, and the hole "
                "takes 10; allowed: all edges of a cut through the sheet"));
}

/// Digits of a file's writer may differ in the last places.
TEST(MeshSections, RoundOffIsAllowed) {
  std::string json = sheet_with(section("a", "+x", "[1, 2], [2, 3]"));
  const auto shift = [&](const std::string& x) {
    std::string moved = json;
    return moved.replace(moved.find("[20, 10]"), 8, fmt::format("[{}, 10]", x));
  };
  EXPECT_EQ(message(shift("20.000000001")), "no error");
  EXPECT_THAT(message(shift("20.0000001")), HasSubstr("is not perpendicular to x"));
}

}  // namespace
}  // namespace fastjoint::named_edges_test
