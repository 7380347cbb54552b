// SPDX-License-Identifier: GPL-3.0-or-later
// scripts/measure/make_panel prints the panels on which the tests and the benchmarks work.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/files.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using nlohmann::json;

test::Run make_panel(const std::string& words) {
  const test::TemporaryFolder folder;
  return test::run(folder, fmt::format("'{}' {}", FASTJOINT_MAKE_PANEL, words));
}

json printed(const std::string& words) {
  const auto run = make_panel(words);
  EXPECT_EQ(run.status, 0) << run.err;
  return json::parse(run.out);
}

TEST(MakePanel, PrintsThePanelOfTheTests) {
  EXPECT_EQ(printed("1 1 --rings 0"), json::parse(test::panel(1, 1)));
  EXPECT_EQ(printed("3 2 --rings 2"), json::parse(test::panel(3, 2, 2)));
}

/// What a scene says of rings, --accuracy keeps.
TEST(MakePanel, LeavesRingsOpenUnlessAsked) {
  auto scene = json::parse(test::panel(2, 1));
  for (auto& hole : scene["holes"]) hole.erase("rings");
  EXPECT_EQ(printed("2 1"), scene);
}

TEST(MakePanel, TakesDegreesAndSpace) {
  auto scene = json::parse(test::panel(1, 1));
  scene["holes"][0].erase("rings");
  scene["p"] = {4, 8};
  EXPECT_EQ(printed("1 1 --p 4..8"), scene);
  scene["space"] = "product";
  EXPECT_EQ(printed("1 1 --p 4..8 --space product"), scene);
}

TEST(MakePanel, RefusesOtherWords) {
  for (const auto& [words, message] : {std::pair{"0 1", "argument NX: '0'; allowed: 1..1000"},
                                       {"1 1e3", "argument NY: '1e3'; allowed: 1..1000"},
                                       {"1 1 --rings -1", "argument --rings: "},
                                       {"1 1 --rings 21", "argument --rings: '21'; allowed: 0..20"},
                                       {"1 1 --p 8..4", "argument --p: '8..4'; allowed: A..B, 1 <= A <= B <= 8"},
                                       {"1 1 --p 4..9", "argument --p: '4..9'"},
                                       {"1 1 --space serendipity", "choose from 'trunk', 'product'"}}) {
    const auto run = make_panel(words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.out, "") << words;
    EXPECT_THAT(run.err, testing::HasSubstr(message)) << words;
  }
}

}  // namespace
}  // namespace fastjoint
