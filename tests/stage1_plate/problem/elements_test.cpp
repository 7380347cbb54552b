// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/elements.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

std::size_t n_kinds(const std::string& json) { return test::make_plate(json).problem.elements.kinds.size(); }

TEST(Elements, OfARivetedPanelAreOfEightKinds) {
  const auto elements = test::make_plate(test::panel(4, 3)).problem.elements;
  EXPECT_EQ(elements.kind.size(), 12U * 8U);
  EXPECT_EQ(elements.kinds.size(), 8U);
  EXPECT_EQ(elements.stiffness.size(), 8U);
  EXPECT_EQ(n_kinds(test::panel(2, 2, 2)), 24U) << "each ring has its own";
}

/// What is condensed with an element is free and no other's.
TEST(Elements, WhatIsCondensedIsTheirOwn) {
  const auto plate = test::make_plate(test::panel(3, 2, 1));
  const auto& [numbering, unknowns] = std::tie(plate.problem.numbering, plate.problem.unknowns);
  std::vector<int> n_elements(numbering.n_functions.back(), 0);
  for (const int function : numbering.function.reshaped()) ++n_elements[function];
  int n_condensed = 0;
  for (Eigen::Index element = 0; element < numbering.function.cols(); ++element) {
    const auto& elements = plate.problem.elements;
    const auto& kind = elements.kinds[elements.kind[element]];
    for (Eigen::Index mode = 0; mode < numbering.function.rows(); ++mode) {
      if (kind.kept[mode]) continue;
      const std::size_t function = numbering.function(mode, element);
      ++n_condensed;
      EXPECT_EQ(n_elements[function], 1);
      EXPECT_TRUE(stage1::Unknowns::is_free(unknowns.target[2 * function]));
      EXPECT_TRUE(stage1::Unknowns::is_free(unknowns.target[2 * function + 1]));
    }
  }
  EXPECT_EQ(n_condensed, 6 * (16 * 15 + 8 * 7)) << "interior modes and those of rims";
}

/// Two holes side by side; what differs between them makes other kinds, thickness does not.
TEST(Elements, TellWhatDiffers) {
  const auto pair = [](const char* thickness, const char* spring, double radius, double y) {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
      "geometry": {{"grid": {{"x": [0, 1, 2], "y": [0, 1], "thickness": {}}}}},
      "holes": [{{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {{"modulus": 1e6}}}},
                {{"id": "b", "center": [1.5, {}], "radius": {}, "spring": {}}}]}})",
                       thickness, y, radius, spring);
  };
  const char* same = R"({"modulus": 1e6})";
  EXPECT_EQ(n_kinds(pair("0.1", same, 0.2, 0.5)), 8U);
  EXPECT_EQ(n_kinds(pair("[[0.1, 0.3]]", same, 0.2, 0.5)), 8U);
  EXPECT_EQ(n_kinds(pair("0.1", R"({"modulus": 1.0000001e6})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_kinds(pair("0.1", R"({"modulus": 1e6, "arc": [-90, 90]})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_kinds(pair("0.1", R"({"links": 1e6})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_kinds(pair("0.1", same, 0.2000001, 0.5)), 16U);
  EXPECT_EQ(n_kinds(pair("0.1", same, 0.2, 0.5000001)), 16U);
}

/// Links do not scale with the thickness as springs do.
TEST(Elements, WithLinksAreOfAKindForEachThickness) {
  const std::string links = R"({"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {"al": {"E": 1e7, "nu": 0.3}},
      "geometry": {"grid": {"x": [0, 1, 2], "y": [0, 1], "thickness": [[0.1, 0.2]]}},
      "holes": [{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {"links": 100}},
                {"id": "b", "center": [1.5, 0.5], "radius": 0.2, "spring": {"links": 100}}]})";
  EXPECT_EQ(n_kinds(links), 16U);
}

}  // namespace
}  // namespace fastjoint
