// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::HasSubstr;

/// Discs of hole "h" and point "k" in the given directions; externals P (rigid) and T (traction).
std::string scene(const std::string& loads, const std::string& directions = R"(["x", "y"])",
                  const std::string& only = "true") {
  return R"({"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"al": {"E": 1e7, "nu": 0.3}},
    "geometry": {"grid": {"x": [0, 1], "y": [0, 1], "thickness": 0.1}},
    "holes": [{"id": "h", "center": [0.5, 0.5], "radius": 0.2, "spring": {"modulus": 1, "compression_only": )" +
         only + R"(}}], "points": [{"id": "k", "at": [0, 0], "stiffness": 1}], "disc_directions": )" + directions +
         R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
         {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])" +
         loads + "}";
}

stage1::PlateScene read(const std::string& json) { return stage1::read_scene(input::parse("plate.json", json)); }

std::string message(const std::string& json) {
  return test::message_of([&] { return read(json); });
}

TEST(ReadLoads, WhatIsNotListedIsFreeOrHeld) {
  const auto loads = read(scene(R"(, "loads": [{"external": "T", "force": 3},
    {"disc": "h", "direction": "y", "force": 2, "friction": 0.1}])"))
                         .loads.value();
  ASSERT_EQ(loads.external.size(), 2U);
  EXPECT_TRUE(loads.external[0].is_force);
  EXPECT_EQ(loads.external[0].value, 0);
  EXPECT_EQ(loads.external[1].value, 3);
  ASSERT_EQ(loads.disc.size(), 4U);  // h x, h y, k x, k y
  EXPECT_FALSE(loads.disc[0].is_force);
  EXPECT_TRUE(loads.disc[1].is_force);
  EXPECT_EQ(loads.disc[1].value, 2);
  EXPECT_EQ(loads.disc[1].friction, 0.1);
  EXPECT_FALSE(loads.disc[3].is_force);
}

TEST(ReadLoads, OneDirectionNeedNotBeNamed) {
  const auto loads = read(scene(R"(, "loads": [{"disc": "k", "displacement": 4}])", R"(["y"])")).loads.value();
  EXPECT_EQ(loads.disc[1].value, 4);
}

TEST(ReadLoads, MayBeThereWithContactOnly) {
  EXPECT_FALSE(read(scene("")).loads) << "a joint gives them";
  const std::string loads = R"(, "loads": [{"external": "P", "force": 1}])";
  EXPECT_THAT(message(scene(loads, R"(["x"])", "false")),
              HasSubstr("/loads: given, but no hole has springs with \"compression_only\""));
  EXPECT_EQ(message(scene("", R"(["x"])", "false")), "no error");
}

TEST(ReadLoads, RefusesWhatIsNoLoad) {
  const auto one = [](const std::string& load) { return message(scene(R"(, "loads": [)" + load + "]")); };
  EXPECT_THAT(one(R"({"force": 1})"), HasSubstr("allowed: either \"external\" or \"disc\""));
  EXPECT_THAT(one(R"({"external": "P"})"), HasSubstr("allowed: either \"force\" or \"displacement\""));
  EXPECT_THAT(one(R"({"external": "P", "force": 1, "displacement": 1})"), HasSubstr("/loads/0: {"));
  EXPECT_THAT(one(R"({"external": "P", "force": 1, "direction": "x"})"), HasSubstr("/loads/0/direction: unknown key"));
  EXPECT_THAT(one(R"({"external": "Q", "force": 1})"),
              HasSubstr("/loads/0/external: \"Q\" is not allowed; allowed: \"P\", \"T\""));
  EXPECT_THAT(one(R"({"external": "T", "displacement": 1})"),
              HasSubstr("/loads/0/displacement: external \"T\" does not move as one"));
  EXPECT_THAT(one(R"({"disc": "g", "force": 1})"),
              HasSubstr("/loads/0/disc: \"g\" is not allowed; allowed: \"h\", \"k\""));
  EXPECT_THAT(one(R"({"disc": "h", "force": 1})"), HasSubstr("/loads/0: key \"direction\" is missing"));
  EXPECT_THAT(one(R"({"disc": "h", "direction": "x", "force": 1, "friction": -0.1})"), HasSubstr("/loads/0/friction"));
  EXPECT_THAT(one(R"({"disc": "k", "direction": "x", "force": 1, "friction": 0.1})"),
              HasSubstr("/loads/0/friction: \"k\" is a point, which has no rim"));
  EXPECT_THAT(one(R"({"external": "P", "force": 1}, {"external": "P", "force": 2})"),
              HasSubstr("/loads/1/external: loaded twice"));
  EXPECT_THAT(one(R"({"external": "P", "force": 0})"), HasSubstr("/loads: every force and displacement is 0"));
}

}  // namespace
}  // namespace fastjoint
