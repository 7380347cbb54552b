// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

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
  const auto free = count("");  // one element
  for (int p = 1; p <= 8; ++p) EXPECT_EQ(free.n_free[p], 2 * (p + 1) * (p + 1));
  const auto held = count(R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])");
  EXPECT_EQ(held.n_free[8], free.n_free[8] - 2 * (2 + 7));
  const auto rigid = count(R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])");
  EXPECT_EQ(rigid.n_free[8], free.n_free[8] - (2 + 7));
  EXPECT_EQ(rigid.n_controlled(), 1);
}

TEST(Unknowns, OpenHolesHaveNoDisc) {
  const auto unknowns =
      test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.5, 0.5, 0.2, 0, false}, {"b", 1.5, 0.5, 0.2}},
                                        R"(, "disc_directions": ["x", "y"])"))
          .problem.unknowns;
  EXPECT_EQ(unknowns.disc_hole, (std::vector<std::string>{"b", "b"}));
  EXPECT_EQ(unknowns.disc_direction, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(unknowns.first_disc, (std::vector<int>{0, 0, 2}));
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
  EXPECT_THAT(
      message(R"(, "supports": [{"on": "top", "fix": ["x"]}],
                        "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"),
      HasSubstr(
          "/external: external \"P\" moves the plate in x at (1, 1), where a support or another external holds it"));
  EXPECT_THAT(message(R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                        {"id": "Q", "on": "top", "direction": "x", "kind": "rigid"}])"),
              HasSubstr("external \"Q\" moves the plate in x at (1, 1)"));
  EXPECT_EQ(message(R"(, "supports": [{"on": "top", "fix": ["y"]}],
                        "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"),
            "no error");
}

}  // namespace
}  // namespace fastjoint
