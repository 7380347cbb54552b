// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/cells.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

std::size_t n_shapes(const std::string& json) { return test::make_plate(json).problem.cells.shapes.size(); }

TEST(Cells, ARivetedPanelHasOneShape) {
  const auto plate = test::make_plate(test::panel(4, 3));
  EXPECT_EQ(plate.problem.cells.cells.size(), 12U);
  EXPECT_EQ(plate.problem.cells.shapes.size(), 1U);
  EXPECT_EQ(plate.problem.cells.element_stiffness.size(), 8U);
}

/// A cell's functions and signs name those of the plate: what it has inside belongs to no other cell.
TEST(Cells, InsideBelongsToOneCell) {
  const auto plate = test::make_plate(test::panel(3, 2, 1));
  const auto& problem = plate.problem;
  std::vector<int> n_cells(static_cast<std::size_t>(problem.numbering.n_functions.back()), 0);
  for (const auto& cell : problem.cells.cells)
    for (const int function : cell.function) ++n_cells[static_cast<std::size_t>(function)];
  std::size_t n_inside = 0;
  for (const auto& cell : problem.cells.cells) {
    const auto& shape = problem.cells.shapes[static_cast<std::size_t>(cell.shape)];
    for (std::size_t f = 0; f < cell.function.size(); ++f) {
      if (shape.kept[f]) continue;
      ++n_inside;
      EXPECT_EQ(n_cells[static_cast<std::size_t>(cell.function[f])], 1);
    }
  }
  EXPECT_GT(n_inside, n_cells.size() / 2);
}

/// Two holes side by side; what differs between them makes a second shape, thickness does not.
TEST(Cells, TellWhatDiffers) {
  const auto pair = [](const char* thickness, const char* spring, double radius, double y) {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
      "geometry": {{"grid": {{"x": [0, 1, 2], "y": [0, 1], "thickness": {}}}}},
      "holes": [{{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {{"modulus": 1e6}}}},
                {{"id": "b", "center": [1.5, {}], "radius": {}, "spring": {}}}]}})",
                       thickness, y, radius, spring);
  };
  const char* same = R"({"modulus": 1e6})";
  EXPECT_EQ(n_shapes(pair("0.1", same, 0.2, 0.5)), 1U);
  EXPECT_EQ(n_shapes(pair("[[0.1, 0.3]]", same, 0.2, 0.5)), 1U);
  EXPECT_EQ(n_shapes(pair("0.1", R"({"modulus": 1.0000001e6})", 0.2, 0.5)), 2U);
  EXPECT_EQ(n_shapes(pair("0.1", R"({"modulus": 1e6, "arc": [-90, 90]})", 0.2, 0.5)), 2U);
  EXPECT_EQ(n_shapes(pair("0.1", R"({"links": 1e6})", 0.2, 0.5)), 2U);
  EXPECT_EQ(n_shapes(pair("0.1", same, 0.2000001, 0.5)), 2U);
  EXPECT_EQ(n_shapes(pair("0.1", same, 0.2, 0.5000001)), 2U);
}

/// Links do not scale with the thickness as springs do.
TEST(Cells, LinksInCellsOfTwoThicknessesAreTwoShapes) {
  const std::string links = R"({"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {"al": {"E": 1e7, "nu": 0.3}},
      "geometry": {"grid": {"x": [0, 1, 2], "y": [0, 1], "thickness": [[0.1, 0.2]]}},
      "holes": [{"id": "a", "center": [0.5, 0.5], "radius": 0.2, "spring": {"links": 100}},
                {"id": "b", "center": [1.5, 0.5], "radius": 0.2, "spring": {"links": 100}}]})";
  EXPECT_EQ(n_shapes(links), 2U);
}

}  // namespace
}  // namespace fastjoint
