// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::HasSubstr;

TEST(Unknowns, SupportsAndExternalsTakeAwayTheirs) {
  const auto count = [](const std::string& extra) {
    return test::make_plate(test::grid_scene({0, 1}, {0, 1}, {}, extra)).problem.unknowns;
  };
  const auto free = count("");  // one element, held against the three rigid motions
  for (int p = 1; p <= 8; ++p) EXPECT_EQ(free.n_free[p], 2 * (p + 1) * (p + 1) - 3);
  EXPECT_TRUE(free.held_at);
  constexpr int all = 2 * 9 * 9;
  const auto held = count(R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])");
  EXPECT_EQ(held.n_free[8], all - 2 * (2 + 7));
  const auto rigid = count(R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])");
  EXPECT_EQ(rigid.n_free[8], all - (2 + 7));
  EXPECT_FALSE(held.held_at || rigid.held_at);
  EXPECT_EQ(rigid.n_controlled(), 1);
}

TEST(Unknowns, OpenHolesHaveNoDisc) {
  const auto unknowns =
      test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.5, 0.5, 0.2, 0, false}, {"b", 1.5, 0.5, 0.2}},
                                        R"(, "disc_directions": ["x", "y"])"))
          .problem.unknowns;
  EXPECT_EQ(unknowns.disc_hole, (std::vector<std::string>{"b", "b"}));
  EXPECT_EQ(unknowns.disc_direction, (std::vector{rim::Axis::x, rim::Axis::y}));
  EXPECT_EQ(unknowns.first_disc, (std::vector<int>{0, 0, 2}));
}

/// Behind the controlled displacements: loaded waves, friction cases, other waves, each by hole.
TEST(Unknowns, ColumnsOfTheBorderAreInTheirOrder) {
  const auto hole = [](const char* id, double x, const char* more) {
    return fmt::format(R"({{"id": "{}", "center": [{}, 0.5], "radius": 0.2, {}}})", id, x, more);
  };
  const auto plate = test::make_plate(fmt::format(
      R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x", "y"],
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 1, 2, 3, 4, 5], "y": [0, 1], "thickness": 0.1}}}},
    "supports": [{{"on": "left", "fix": ["x"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}}],
    "holes": [{}, {}, {}, {}, {}]}})",
      hole("sprung", 0.5, R"("waves": 3, "spring": {"modulus": 1e6})"),
      hole("contact", 1.5, R"("waves": 4, "spring": {"modulus": 1e6, "compression_only": true})"),
      hole("open", 2.5, R"("waves": 5)"), hole("none", 3.5, R"("stresses": false, "spring": {"modulus": 1e6})"),
      hole("contact too", 4.5, R"("waves": 6, "spring": {"modulus": 1e6, "compression_only": true})")));
  const auto& unknowns = plate.problem.unknowns;
  constexpr int nc = 1 + 4 * 2, loaded = 2 * 9 + 2 * 13, friction = 2 * 4, others = 2 * 7 + 2 * 11;
  EXPECT_EQ(unknowns.n_controlled(), nc);
  EXPECT_EQ(unknowns.n_loaded, loaded);
  EXPECT_EQ(unknowns.n_friction, friction) << "none in contact";
  EXPECT_EQ(unknowns.n_other, others);
  EXPECT_EQ(unknowns.n_prescribed(), nc + loaded + friction);
  EXPECT_EQ(unknowns.n_border(), nc + loaded + friction + others);
  EXPECT_EQ(unknowns.n_waves, (std::vector<int>{14, 18, 22, 0, 26}));
  EXPECT_EQ(unknowns.n_cases, (std::vector<int>{4, 0, 0, 4, 0}));
  constexpr int first_other = nc + loaded + friction;
  EXPECT_EQ(unknowns.first_wave, (std::vector<int>{first_other, nc, first_other + 14, 0, nc + 18}));
  EXPECT_EQ(unknowns.first_friction[0], nc + loaded);
  EXPECT_EQ(unknowns.first_friction[3], nc + loaded + 4);
  std::vector<int> expected = {1, 2};  // its discs, then its waves and friction cases
  for (int i = 0; i < 14; ++i) expected.push_back(first_other + i);
  for (int i = 0; i < 4; ++i) expected.push_back(nc + loaded + i);
  EXPECT_EQ(unknowns.border_of({0}), expected);
  EXPECT_EQ(plate.problem.friction_hole,
            (std::vector<std::string>{"sprung", "sprung", "sprung", "sprung", "none", "none", "none", "none"}));
}

TEST(Unknowns, TwoMastersOfOneDisplacementAreRefused) {
  const auto message = [](const std::string& extra) -> std::string {
    try {
      (void)test::make_plate(test::grid_scene({0, 1}, {0, 1}, {}, extra));
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(message(R"(, "supports": [{"on": "top", "fix": ["x"]}],
                        "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"),
              HasSubstr("/external: external \"P\" moves the plate in x at (1, 1), where a support or another external "
                        "prescribes it"));
  EXPECT_THAT(message(R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                        {"id": "Q", "on": "top", "direction": "x", "kind": "rigid"}])"),
              HasSubstr("external \"Q\" moves the plate in x at (1, 1)"));
  EXPECT_EQ(message(R"(, "supports": [{"on": "top", "fix": ["y"]}],
                        "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"),
            "no error");
}

}  // namespace
}  // namespace fastjoint
