// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_stiffness.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

std::size_t n_classes(const std::string& json) { return test::make_plate(json).problem.elements.classes.size(); }

TEST(Elements, OfARivetedPanelAreOfEightClasses) {
  const auto elements = test::make_plate(test::panel(4, 3)).problem.elements;
  EXPECT_EQ(elements.class_of.size(), 12U * 8U);
  EXPECT_EQ(elements.classes.size(), 8U);
  EXPECT_EQ(elements.stiffness.size(), 8U);
  EXPECT_EQ(n_classes(test::panel(2, 2, 2)), 24U) << "each ring has its own";
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
    const auto& kept = elements.classes[elements.class_of[element]].kept;
    for (Eigen::Index mode = 0; mode < numbering.function.rows(); ++mode) {
      if (kept[mode]) continue;
      const std::size_t function = numbering.function(mode, element);
      ++n_condensed;
      EXPECT_EQ(n_elements[function], 1);
      EXPECT_TRUE(pfem::is_free(unknowns.dofs(0, function)));
      EXPECT_TRUE(pfem::is_free(unknowns.dofs(1, function)));
    }
  }
  EXPECT_EQ(n_condensed, 6 * (16 * 49 + 8 * 7)) << "interior modes and those of rims";
}

/// Two holes side by side; what differs between them makes other classes, thickness does not.
TEST(Elements, TellWhatDiffers) {
  const auto pair = [](const char* thickness, const char* spring, double radius, double y, const char* more = "") {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
      "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
      "geometry": {{"grid": {{"x": [0, 1, 2], "y": [0, 1], "thickness": {}}}}},
      "holes": [{{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {{"modulus": 1e6}}}},
                {{"id": "b", "center": [1.5, {}], "radius": {}, "spring": {}{}}}]}})",
                       thickness, y, radius, spring, more);
  };
  const char* same = R"({"modulus": 1e6})";
  EXPECT_EQ(n_classes(pair("0.1", same, 0.2, 0.5)), 8U);
  EXPECT_EQ(n_classes(pair("[[0.1, 0.3]]", same, 0.2, 0.5)), 8U);
  EXPECT_EQ(n_classes(pair("0.1", R"({"modulus": 1.0000001e6})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_classes(pair("0.1", R"({"modulus": 1e6, "arc": [-90, 90]})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_classes(pair("0.1", R"({"links": 1e6})", 0.2, 0.5)), 16U);
  EXPECT_EQ(n_classes(pair("0.1", same, 0.2000001, 0.5)), 16U);
  EXPECT_EQ(n_classes(pair("0.1", same, 0.2, 0.5000001)), 16U);
  EXPECT_EQ(n_classes(pair("0.1", same, 0.2, 0.5, R"(, "waves": 11)")), 16U);
  EXPECT_EQ(n_classes(pair("0.1", same, 0.2, 0.5, R"(, "stresses": false)")), 16U);
  EXPECT_EQ(n_classes(pair("0.1", R"({"modulus": 1e6, "compression_only": true})", 0.2, 0.5, R"(, "rings": 0)")), 16U);
}

/// Links do not scale with the thickness as springs do.
TEST(Elements, WithLinksAreOfAClassForEachThickness) {
  const std::string links = R"({"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
      "materials": {"al": {"E": 1e7, "nu": 0.3}},
      "geometry": {"grid": {"x": [0, 1, 2], "y": [0, 1], "thickness": [[0.1, 0.2]]}},
      "holes": [{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {"links": 100}},
                {"id": "b", "center": [1.5, 0.5], "radius": 0.2, "spring": {"links": 100}}]})";
  EXPECT_EQ(n_classes(links), 16U);
}

}  // namespace
}  // namespace fastjoint
