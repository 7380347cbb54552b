// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/plate_scenes.hpp"

#include <fmt/format.h>

namespace fastjoint::test {
namespace {

std::string two_holes(const std::string& extra, const char* thickness = "[[0.1, 0.2], [0.1, 0.05]]") {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",{}
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 1, 2.2], "y": [0, 0.9, 1.7], "thickness": {}}}}}{}}})",
                     one_direction(extra), thickness, extra);
}

/// A square with a hole at its corner, two elements, by hand; the disc's rim crosses from one to the other.
const char* const own_mesh = R"({"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
  "materials": {"al": {"E": 1e7, "nu": 0.3}},
  "geometry": {"mesh": {"nodes": [[0.5, 0], [2, 0], [2, 2], [0.3535533905932738, 0.3535533905932738], [0, 2], [0, 0.5]],
    "quads": [[0, 1, 2, 3], [3, 2, 4, 5]], "arcs": [{"edge": [0, 3], "center": [0, 0]}, {"edge": [3, 5], "center": [0, 0]}],
    "thickness": 0.1, "edges": {"low": [[0, 1]], "side": [[4, 5]]}}},
  "holes": [{"id": "h", "center": [0, 0], "radius": 0.5, "spring": {"disk": {"E": 1e7, "nu": 0.3}}}],
  "supports": [{"on": "low", "fix": ["y"]}, {"on": "side", "fix": ["x"]}]})";

}  // namespace

std::vector<PlateText> plate_scenes() {
  const std::string holes = R"(, "disc_directions": ["x", "y"],
    "holes": [{"id": "a", "center": [0.4, 0.5], "radius": 0.2, "rings": 1, "spring": {"modulus": 1e6}},
              {"id": "b", "center": [1.5, 1.3], "radius": 0.2, "spring": {"links": 1e5}},
              {"id": "open", "center": [1.7, 0], "radius": 0.3}])";
  const std::string contact = R"(, "disc_directions": ["x", "y"],
    "holes": [{"id": "a", "center": [0.4, 0.5], "radius": 0.2, "waves": 5,
               "spring": {"modulus": 1e7, "compression_only": true}},
              {"id": "half", "center": [1.6, 0], "radius": 0.25, "rings": 0, "waves": 6,
               "spring": {"modulus": 1e6, "compression_only": true}},
              {"id": "open", "center": [1.7, 1.3], "radius": 0.2, "waves": 4},
              {"id": "sprung", "center": [0.5, 1.35], "radius": 0.15, "spring": {"modulus": 1e7, "arc": [-80, 30]}}],
    "supports": [{"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])";
  return {{"panel", panel(3, 2)},
          {"panel in the product space", panel(3, 2, 0, in_space(pfem::Space::product))},
          {"panel with many rings, element by element", panel(2, 1, 4)},
          {"floating, two thicknesses, traction, rigid edge",
           two_holes(holes + R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                       {"id": "T", "on": "top", "direction": "y", "kind": "traction"},
                                       {"id": "B", "on": "open", "direction": "x", "kind": "bearing"}])")},
          {"half holes on supports and on an external", two_holes(R"(,
         "holes": [{"id": "a", "center": [0.4, 0], "radius": 0.2, "spring": {"disk": {"E": 1e7, "nu": 0.3}}},
                   {"id": "b", "center": [2.2, 1.3], "radius": 0.2, "spring": {"modulus": 1e7, "arc": [100, 200]}}],
         "supports": [{"on": "bottom", "fix": ["y"]}, {"on": "left", "fix": ["x"]}],
         "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])")},
          {"points", two_holes(R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
         "points": [{"id": "K", "at": [2.2, 0.9], "stiffness": 1e5}, {"id": "L", "at": [1, 0.9], "stiffness": 3e4}])")},
          {"contact beside springs and open holes", two_holes(contact)},
          {"own mesh", own_mesh}};
}

}  // namespace fastjoint::test
