// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string mesh_scene(const std::string& nodes, const std::string& quads, const std::string& rest = "",
                       const std::string& more = "") {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"mesh": {{"nodes": [{}], "quads": [{}], "thickness": 1{}}}}}{}}})",
                     nodes, quads, rest, more);
}

std::string message(const std::string& json) {
  return test::message_of([&] { return test::make_plate(json); });
}

const std::string square = "[0,0],[1,0],[1,1],[0,1]";

TEST(ExplicitMesh, MistakesAreNamed) {
  EXPECT_EQ(message(mesh_scene(square, "[0,1,2,3]")), "no error");
  EXPECT_THAT(message(mesh_scene(square, "[0,3,2,1]")), HasSubstr("element 0 near (0.5, 0.5) is folded, clockwise"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,4]")), HasSubstr("/geometry/mesh/quads/0/3: 4 is not allowed"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,2]")), HasSubstr("four different nodes"));
  EXPECT_THAT(message(mesh_scene(square + ",[5,5]", "[0,1,2,3]")),
              HasSubstr("/geometry/mesh/nodes/4: no element uses this node"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3],[0,1,2,3],[0,1,2,3]")),
              HasSubstr("belongs to 3 elements; allowed: at most 2"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", R"(, "edges": {"right": [[0, 2]]})")),
              HasSubstr("/geometry/mesh/edges/right/0: nodes 0 and 2 are not joined"));
  EXPECT_THAT(message(mesh_scene(square + ",[2,0],[2,1]", "[0,1,2,3],[1,4,5,2]", R"(, "edges": {"cut": [[1, 2]]})")),
              HasSubstr("the edge between nodes 1 and 2 is inside the plate"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", R"(, "arcs": [{"edge": [0, 1], "center": [0.4, -1]}])")),
              HasSubstr("/geometry/mesh/arcs/0: its ends are"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", R"(, "arcs": [{"edge": [0, 1], "center": [0.5, 0]}])")),
              HasSubstr("an arc of 3.142 radians"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", R"(, "arcs": [{"edge": [0, 2], "center": [1, 0]}])")),
              HasSubstr("/geometry/mesh/arcs/0/edge: nodes 0 and 2 are not joined"));
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", "", R"(, "supports": [{"on": "left", "fix": ["x"]}])")),
              HasSubstr("/supports/0/on"));
}

/// What stands twice would count twice, or the last alone.
TEST(ExplicitMesh, WhatStandsTwiceIsNamed) {
  for (const char* edge : {"[1, 2]", "[2, 1]"}) {
    const std::string arcs = R"({"edge": [2, 3], "center": [0.5, 0]}, {"edge": [1, 2], "center": [0, 0.5]})";
    EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]",
                                   fmt::format(R"(, "arcs": [{}, {{"edge": {}, "center": [-3, 0.5]}}])", arcs, edge))),
                AllOf(HasSubstr("/geometry/mesh/arcs/2/center: (-3, 0.5), but the same edge is an arc about (0, 0.5)"),
                      HasSubstr("by /geometry/mesh/arcs/1;")));
    EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3]", fmt::format(R"(, "edges": {{"e": [[1, 2], {}]}})", edge))),
                AllOf(HasSubstr("/geometry/mesh/edges/e/1: "), HasSubstr("/geometry/mesh/edges/e/0")));
  }
  EXPECT_EQ(message(mesh_scene(square, "[0,1,2,3]", R"(, "edges": {"e": [[1, 2]], "f": [[2, 1]]})")), "no error");
  EXPECT_THAT(message(mesh_scene(square, "[0,1,2,3],[2,3,0,1]")),
              AllOf(HasSubstr("/geometry/mesh/quads/1: "), HasSubstr("same nodes as /geometry/mesh/quads/0")));
}

TEST(ExplicitMesh, HangingNodesAreFound) {
  const std::string nodes = "[0,0],[1,0],[1,1],[0,1],[2,0],[2,0.5],[1,0.5],[2,1]";
  EXPECT_THAT(message(mesh_scene(nodes, "[0,1,2,3],[1,4,5,6],[6,5,7,2]")),
              HasSubstr("/geometry/mesh/nodes/6: it hangs on the edge between nodes 1 and 2"));
}

/// A node of a ring by its radius and its angle in degrees.
std::string polar(double radius, double angle) {
  const double radians = angle * std::numbers::pi / 180;
  return fmt::format("[{},{}]", radius * std::cos(radians), radius * std::sin(radians));
}

/// A ring from radius 1 to 2 of so many sectors inside one from 2 to 3 of others, whose nodes at radius 2 are shared
/// where they lie at equal angles.
std::string rings_scene(int inner, int outer) {
  std::vector<std::string> nodes, quads, arcs;
  const auto ring = [&](double radius, int n) {
    std::vector<int> ids;
    for (int i = 0; i < n; ++i) {
      nodes.push_back(polar(radius, 360.0 * i / n));
      ids.push_back(static_cast<int>(nodes.size()) - 1);
    }
    return ids;
  };
  const auto sectors = [&](const std::vector<int>& in, const std::vector<int>& out) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const std::size_t next = (i + 1) % in.size();
      quads.push_back(fmt::format("[{},{},{},{}]", in[i], out[i], out[next], in[next]));
      for (const auto& list : {in, out})
        arcs.push_back(fmt::format(R"({{"edge": [{}, {}], "center": [0, 0]}})", list[i], list[next]));
    }
  };
  const auto first = ring(1, inner), middle = ring(2, inner), last = ring(3, outer);
  std::vector<int> shared;
  for (int i = 0; i < outer; ++i) shared.push_back(middle[i * inner / outer]);
  sectors(first, middle);
  sectors(shared, last);
  return mesh_scene(fmt::format("{}", fmt::join(nodes, ",")), fmt::format("{}", fmt::join(quads, ",")),
                    fmt::format(R"(, "arcs": [{}])", fmt::join(arcs, ",")));
}

TEST(ExplicitMesh, NodesThatHangOnArcsAreFound) {
  EXPECT_EQ(message(rings_scene(4, 4)), "no error");
  EXPECT_EQ(message(rings_scene(8, 8)), "no error");
  EXPECT_THAT(message(rings_scene(8, 4)),
              HasSubstr("/geometry/mesh/nodes/9: it hangs on the edge between nodes 8 and 10"));
  // two straight edges whose common node lies on the neighbour's arc, with the digits of a hand-written file
  const std::string nodes =
      "[0,0],[1,0],[0.70710678,0.70710678],[0.3,0.3],[2,0],[2,1.5],[0.9238795,0.3826834],[1.6,0.6]";
  EXPECT_THAT(
      message(mesh_scene(nodes, "[0,1,2,3],[1,4,7,6],[6,7,5,2]", R"(, "arcs": [{"edge": [1, 2], "center": [0, 0]}])")),
      HasSubstr("/geometry/mesh/nodes/6: it hangs on the edge between nodes 1 and 2"));
}

/// Two squares side by side that do not share the two nodes between them.
TEST(ExplicitMesh, ASlitBetweenNodesThatLieOnOneAnotherIsFound) {
  const std::string nodes = square + ",[1,0],[2,0],[2,1],[1,1]";
  EXPECT_THAT(message(mesh_scene(nodes, "[0,1,2,3],[4,5,6,7]")),
              AllOf(HasSubstr("/geometry/mesh/nodes/4: it lies on node 1, but no element joins the two"),
                    HasSubstr("allowed: one node at each place")));
  EXPECT_THAT(message(mesh_scene(square + ",[2,0],[2,1],[1,1]", "[0,1,2,3],[1,4,5,6]")),
              HasSubstr("/geometry/mesh/nodes/6: it lies on node 2"));
  for (const char* at :
       {"[1.0000001,0]", "[0.9999999,0]", "[1,1e-7]", "[1,-1e-7]"})  // digits of a file written by hand
    EXPECT_THAT(message(mesh_scene(square + "," + at + ",[2,0],[2,1],[1,1]", "[0,1,2,3],[4,5,6,7]")),
                HasSubstr("it lies on node"))
        << at;
  EXPECT_EQ(message(mesh_scene(square + ",[2,0],[2,1]", "[0,1,2,3],[1,4,5,2]")), "no error");
  EXPECT_EQ(message(mesh_scene(square + ",[1.0000001,0],[1.0000001,1],[2,0],[2,1]", "[0,1,2,3],[1,4,5,2],[4,6,7,5]")),
            "no error")
      << "a short edge is an edge";
}

TEST(ExplicitMesh, HolesMustBeInTheMesh) {
  EXPECT_THAT(
      message(mesh_scene(square, "[0,1,2,3]", "", R"(, "holes": [{"id": "a", "center": [0, 0], "radius": 0.2}])")),
      AllOf(HasSubstr("/holes/0: the mesh has 0 degrees of boundary arcs of radius 0.2 about (0, 0)"),
            HasSubstr("allowed: 360 degrees")));
}

/// The paper's half plate: 14 elements, 22 vertices, 35 edges, 4 of them on the line of symmetry. Two of six elements
/// are replaced by five each (one inside, four around it), which keeps the border.
/// @param first, others Centres of the first arc and of the others.
std::string paper_half_plate(const std::string& first = "[0, 0]", const std::string& others = "[0, 0]") {
  const double c = 10 / std::sqrt(2.0);
  const std::string nodes = fmt::format(
      "[10,0],[{0},{0}],[0,10],[-{0},{0}],[-10,0],"  // 0-4 rim
      "[50,0],[50,100],[0,100],[-50,100],[-50,0],"   // 5-9 outline of the hole's cell
      "[100,0],[100,100],[-100,100],[-100,0],"       // 10-13 corners
      "[65,30],[85,30],[85,70],[65,70],"             // 14-17 inside the right cell
      "[-85,30],[-65,30],[-65,70],[-85,70]",         // 18-21 inside the left cell
      c);
  const std::string quads =
      "[0,5,6,1],[1,6,7,2],[2,7,8,3],[3,8,9,4],"
      "[14,15,16,17],[5,10,15,14],[10,11,16,15],[11,6,17,16],[6,5,14,17],"
      "[18,19,20,21],[13,9,19,18],[9,8,20,19],[8,12,21,20],[12,13,18,21]";
  return mesh_scene(nodes, quads,
                    fmt::format(R"(, "arcs": [{{"edge": [0, 1], "center": {0}}}, {{"edge": [1, 2], "center": {1}}},
                       {{"edge": [2, 3], "center": {1}}}, {{"edge": [3, 4], "center": {1}}}],
                       "edges": {{"symmetry": [[0, 5], [5, 10], [4, 9], [9, 13]], "top": [[12, 8], [8, 7], [7, 6], [6, 11]]}})",
                                first, others),
                    R"(, "space": "trunk",
                       "holes": [{"id": "pin", "center": [0, 0], "radius": 10, "spring": {"disk": {"E": 244, "nu": 0.41}}}],
                       "supports": [{"on": "symmetry", "fix": ["y"]}],
                       "external": [{"id": "T", "on": "top", "direction": "y", "kind": "traction"}])");
}

TEST(ExplicitMesh, FourteenElementHalfPlateHas920UnknownsAtP8) {
  const test::Plate plate = test::make_plate(paper_half_plate());
  EXPECT_EQ(plate.mesh.mesh.n_elements(), 14);
  EXPECT_EQ(plate.mesh.mesh.n_nodes(), 22);
  EXPECT_EQ(plate.mesh.edges.size(), 35);
  EXPECT_EQ(plate.problem.unknowns.n_free[8], 920);
}

/// Centres that differ by less than 1e-6 of the radius are one: all sides meet, and the half hole is on its line.
TEST(ExplicitMesh, DigitsOfAHandWrittenFileMakeNoOtherRim) {
  for (const auto& [first, others] :
       {std::pair("[9e-6, 0]", "[0, 0]"), {"[0, 0]", "[-4e-6, 5e-6]"}, {"[0, -4e-6]", "[0, -4e-6]"}}) {
    const test::Plate plate = test::make_plate(paper_half_plate(first, others));
    const auto& mesh = plate.mesh;
    EXPECT_EQ(rim::open_pieces(rim::side_angles(mesh.mesh, mesh.edges, mesh.rims[0])).size(), 1U) << first << others;
    EXPECT_EQ(plate.problem.unknowns.disc_direction, std::vector{rim::Axis::x}) << first << others;
    EXPECT_TRUE(stage1::missing_symmetry(plate.scene, mesh, plate.problem.unknowns).empty()) << first << others;
  }
  EXPECT_THAT(message(paper_half_plate("[2e-5, 0]")), HasSubstr("135 degrees"));
}

/// What stage 1 takes as a rim, PLATE.h5 may hold: nodes may follow centres that are on both sides of the hole's.
TEST(ExplicitMesh, ARimOfDifferentCentresIsReadAgain) {
  const double side = std::sqrt(0.5), shift = 9e-7;
  const std::string nodes =
      fmt::format("[{0},-{1}],[{0},{1}],[-{0},{1}],[-{0},-{1}],[5,-5],[5,5],[-5,5],[-5,-5]", side + shift, side);
  const test::Plate plate = test::make_plate(mesh_scene(
      nodes, "[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0]",
      R"(, "edges": {"left": [[6, 7]]}, "arcs": [{"edge": [0, 1], "center": [9e-7, 0]}, {"edge": [1, 2], "center": [0, 0]},
        {"edge": [2, 3], "center": [-9e-7, 0]}, {"edge": [3, 0], "center": [0, 0]}])",
      R"(, "p": [2, 3], "holes": [{"id": "h", "center": [0, 0], "radius": 1}], "supports": [{"on": "left", "fix": ["x", "y"]}])"));
  EXPECT_NO_THROW(formats::check_consistent("plate.h5", test::solve(plate)));
}

/// The set of edges that lies on the line of a half hole is the one to support.
TEST(ExplicitMesh, ALineOfSymmetryWithoutSupportIsNamed) {
  for (const bool named : {true, false}) {
    std::string json = paper_half_plate();
    const std::string support = R"({"on": "symmetry", "fix": ["y"]})", set = "[[0, 5], [5, 10], [4, 9], [9, 13]]";
    json.replace(json.find(support), support.size(), R"({"on": "symmetry", "fix": ["x"]})");
    if (!named) json.replace(json.find(set), set.size(), "[[10, 11]]");
    const test::Plate plate = test::make_plate(json);
    EXPECT_THAT(stage1::missing_symmetry(plate.scene, plate.mesh, plate.problem.unknowns),
                testing::ElementsAre(HasSubstr(named ? "add " + support : "name the edges on this line")));
  }
}

TEST(ExplicitMesh, TwoHolesOnOneRimAreRefused) {
  std::string json = paper_half_plate();
  const std::string holes = "\"holes\": [";
  json.insert(json.find(holes) + holes.size(), R"({"id": "open", "center": [0, 0], "radius": 10}, )");
  EXPECT_THAT(message(json), AllOf(HasSubstr("/holes/1: hole \"pin\""), HasSubstr("hole \"open\", /holes/0")));
}

}  // namespace
}  // namespace fastjoint
