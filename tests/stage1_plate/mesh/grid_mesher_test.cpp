// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <numbers>
#include <random>

#include "common/errors.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::grid_mesher_test {
namespace {

using test::HoleText;
using testing::HasSubstr;

stage1::PlateMesh mesh(const std::string& json) {
  return stage1::make_mesh(stage1::read_scene(input::parse("plate.json", json)));
}

std::string message(const std::string& json) {
  return test::message_of([&] { return mesh(json); });
}

double area(const stage1::PlateMesh& plate) {
  const auto rule = pfem::gauss(20);
  double sum = 0;
  for (int element = 0; element < plate.mesh.n_elements(); ++element) {
    const pfem::ElementMap map(plate.mesh, plate.edges, element);
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) sum += rule.w[i] * rule.w[j] * map.jacobian(rule.x[i], rule.x[j]).determinant();
  }
  return sum;
}

/// Conforming: an edge that only one element has lies on the border or on a rim; and there are no gaps or overlaps.
void expect_conforming(const stage1::PlateMesh& plate, double expected_area) {
  std::vector<pfem::Side> named;
  for (const auto& [name, sides] : plate.sets) named.insert(named.end(), sides.begin(), sides.end());
  for (const auto& rim : plate.rims) named.insert(named.end(), rim.sides.begin(), rim.sides.end());
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    for (int edge = 0; edge < 4; ++edge) {
      const bool alone = plate.edges.is_border(plate.edges.of({element, edge}));
      const bool is_named = std::find(named.begin(), named.end(), pfem::Side{element, edge}) != named.end();
      EXPECT_EQ(alone, is_named) << "element " << element << " edge " << edge;
    }
  EXPECT_NEAR(area(plate), expected_area, 1e-9 * expected_area);
}

double circle(double radius, double share = 1) { return share * std::numbers::pi * radius * radius; }

TEST(GridMesher, OneHoleIsEightSectors) {
  const auto plate = mesh(test::panel(1, 1));
  EXPECT_EQ(plate.mesh.n_elements(), 8);
  EXPECT_EQ(plate.mesh.n_nodes(), 16);
  expect_conforming(plate, 1 - circle(0.125));
}

TEST(GridMesher, RingsAreGradedCirclesAroundTheHole) {
  const auto plate = mesh(test::panel(1, 1, 2));
  EXPECT_EQ(plate.mesh.n_elements(), 24);
  expect_conforming(plate, 1 - circle(0.125));
  const double ratio = std::cbrt(0.5 / 0.125);
  for (const double radius : {0.125, 0.125 * ratio, 0.125 * ratio * ratio}) {
    int n = 0;
    for (int node = 0; node < plate.mesh.n_nodes(); ++node)
      n += std::abs((plate.mesh.nodes.col(node) - Eigen::Vector2d(0.5, 0.5)).norm() - radius) < 1e-12;
    EXPECT_EQ(n, 8) << radius;
  }
}

TEST(GridMesher, HalfHolesOnEveryBorderAndQuartersInEveryCorner) {
  const std::vector<double> lines = {0, 1, 2, 3};
  const double r = 0.2;
  const auto plate = mesh(test::grid_scene(lines, lines,
                                           {{"b", 1.4, 0, r},
                                            {"t", 1.5, 3, r},
                                            {"l", 0, 1.6, r},
                                            {"r", 3, 1.5, r},
                                            {"bl", 0, 0, r},
                                            {"br", 3, 0, r},
                                            {"tl", 0, 3, r},
                                            {"tr", 3, 3, r},
                                            {"c", 1.3, 1.7, r}}));
  expect_conforming(plate, 9 - circle(r, 4 * 0.5 + 4 * 0.25 + 1));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_GE(plate.rims[i].sides.size(), i < 4 ? 4U : i < 8 ? 2U : 8U);
}

/// A centre line of one hole must not cut through the cell of another: each hole keeps its own fan.
TEST(GridMesher, StaggeredRowsOfDifferentPitchAndRadiusConform) {
  const auto plate = mesh(test::grid_scene({0, 1, 2, 3}, {0, 1, 2, 3},
                                           {{"a", 0.3, 0.5, 0.1},
                                            {"b", 1.7, 0.4, 0.2},
                                            {"c", 0.6, 1.5, 0.25},
                                            {"d", 1.2, 1.6, 0.1, 1},
                                            {"e", 2.5, 2.5, 0.3, 2},
                                            {"f", 0.2, 2.7, 0.12}}));
  expect_conforming(plate, 9 - circle(0.1, 2) - circle(0.2) - circle(0.25) - circle(0.3) - circle(0.12));
}

TEST(GridMesher, ANodeIsPassedThroughPlainCellsToTheNextHole) {
  const auto plate = mesh(test::grid_scene({0, 1}, {0, 1, 2, 3, 4}, {{"a", 0.3, 0.5, 0.1}, {"b", 0.7, 3.5, 0.1}}));
  expect_conforming(plate, 4 - circle(0.1, 2));
  EXPECT_EQ(plate.mesh.n_elements(), 9 + 3 + 3 + 9);  // both plain cells are cut at x = 0.3 and 0.7
}

TEST(GridMesher, NearlyAlignedCentresShareANode) {
  const auto plate = mesh(test::grid_scene({0, 1}, {0, 1, 2}, {{"a", 0.50, 0.5, 0.1}, {"b", 0.52, 1.5, 0.1}}));
  EXPECT_EQ(plate.mesh.n_elements(), 16);
  expect_conforming(plate, 2 - circle(0.1, 2));
}

TEST(GridMesher, RandomLayoutsConform) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<double> x = {0, 0.5 + unit(random), 2 + unit(random), 4};
    const std::vector<double> y = {-1, unit(random) * 0.5, 1.5, 2 + unit(random)};
    std::vector<HoleText> holes;
    double removed = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        if (unit(random) < 0.4) continue;
        const double w = x[i + 1] - x[i], h = y[j + 1] - y[j];
        const double r = (0.05 + 0.2 * unit(random)) * std::min(w, h);
        holes.push_back({fmt::format("{}{}", i, j), x[i] + 1.1 * r + (w - 2.2 * r) * unit(random),
                         y[j] + 1.1 * r + (h - 2.2 * r) * unit(random), r, static_cast<int>(3 * unit(random))});
        removed += circle(r);
      }
    SCOPED_TRACE(trial);
    expect_conforming(mesh(test::grid_scene(x, y, holes)), 4 * (y[3] + 1) - removed);
  }
}

TEST(GridMesher, HolesThatDoNotFitAreNamed) {
  const auto one = [](double x, double y, double r) {
    return message(test::grid_scene({0, 1, 2}, {0, 1}, {{"h7", x, y, r}}));
  };
  EXPECT_EQ(one(0.5, 0.5, 0.2), "no error");
  EXPECT_THAT(one(3, 0.5, 0.2),
              HasSubstr("/holes/0: hole \"h7\" of radius 0.2 about (3, 0.5) reaches outside the plate"));
  EXPECT_THAT(one(0.5, 0.9, 0.2), HasSubstr("reaches outside the plate"));
  EXPECT_THAT(one(0.5, -0.1, 0.2), HasSubstr("reaches outside the plate"));
  EXPECT_THAT(one(0.9, 0.5, 0.2), HasSubstr("reaches over the cell line x = 1"));
  EXPECT_THAT(one(1, 0.5, 0.2), HasSubstr("reaches over the cell line x = 1"));
  EXPECT_THAT(one(1, 0, 0.2), HasSubstr("reaches over the cell line x = 1"));
  EXPECT_THAT(message(test::grid_scene({0, 2}, {0, 1}, {{"a", 0.5, 0.5, 0.2}, {"b", 1.5, 0.5, 0.2}})),
              HasSubstr("/holes/1: holes \"a\" and \"b\" are in one cell; allowed: one hole in a cell"));
}

/// The method has its limit at a hole that comes close to a cell line. The mesh stays valid, and S good, until the
/// ligament is about a thousandth of the radius; there the elements fold and the user is told to move the line.
TEST(GridMesher, CloseToACellLineItWorksUntilItSaysSo) {
  const auto S = [](double line) {
    return test::extract(test::grid_scene({0, line, 4}, {-1, 1}, {{"a", 1, 0.1, 0.25}},
                                          R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])"))
        .matrices.S_dd.back()(0, 0);
  };
  const double reference = S(2.25);
  for (const double gap : {0.1, 0.01, 0.003}) EXPECT_NEAR(S(1.25 + gap) / reference, 1, 2e-3) << "gap=" << gap;
  EXPECT_THAT(message(test::grid_scene({0, 1.25 + 1e-5, 4}, {-1, 1}, {{"a", 1, 0.1, 0.25}})),
              HasSubstr("leave more room between holes and cell lines"));
}

}  // namespace
}  // namespace fastjoint::grid_mesher_test
