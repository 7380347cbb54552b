// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/rim_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fastjoint::stage2 {
namespace {

constexpr double degree = rim::full_turn / 360;

/// One element for each sector of a ring of radii 1 and 2, none shared.
std::vector<RimPoint> points_of(const std::vector<rim::AngleRange>& sectors) {
  pfem::Mesh mesh;
  const Eigen::Index n = sectors.size();
  mesh.nodes.resize(2, 4 * n);
  mesh.quads.resize(4, n);
  mesh.thickness = Eigen::VectorXd::Ones(n);
  mesh.material = Eigen::VectorXi::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [from, to] = sectors[i];
    const Eigen::Vector2d a(std::cos(from * degree), std::sin(from * degree));
    const Eigen::Vector2d b(std::cos(to * degree), std::sin(to * degree));
    mesh.nodes.middleCols<4>(4 * i) << a, 2 * a, 2 * b, b;
    const int first = 4 * static_cast<int>(i);
    mesh.quads.col(i) << first, first + 1, first + 2, first + 3;
    mesh.arcs.push_back({first, first + 3, Eigen::Vector2d::Zero()});
    mesh.arcs.push_back({first + 1, first + 2, Eigen::Vector2d::Zero()});
  }
  const auto edges = pfem::find_edges(mesh);
  return rim_points(mesh, edges, rim::RimFinder(mesh, edges)(Eigen::Vector2d::Zero(), 1));
}

void expect_from_end_to_end(const std::vector<RimPoint>& points, double from, double to, std::size_t n) {
  ASSERT_EQ(points.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = from + (to - from) * static_cast<double>(i) / static_cast<double>(n - 1);
    EXPECT_NEAR(points[i].angle, angle * degree, 1e-12);
    ASSERT_FALSE(points[i].on.empty()) << angle;
  }
}

TEST(RimPoints, OfAHalfAreFiveDegreesApart) {
  expect_from_end_to_end(points_of({{-90, -30}, {-30, 30}, {30, 90}}), -90, 90, 37);
}

/// A sector of a mesh of the user's own may have any angle: no point beyond its end, and one at it.
TEST(RimPoints, OfAnySectorReachItsEnds) {
  expect_from_end_to_end(points_of({{0, 48}}), 0, 48, 11);
  expect_from_end_to_end(points_of({{10, 46}}), 10, 46, 8);
  expect_from_end_to_end(points_of({{20, 21}}), 20, 21, 2);
  expect_from_end_to_end(points_of({{1, 120}, {120, 240}, {240, 360}}), 1, 360, 73);
}

/// A hole wider than its strip has a rim of two pieces.
TEST(RimPoints, OfTwoPiecesLieOnThem) {
  const auto points = points_of({{-20, 20}, {160, 200}});
  ASSERT_EQ(points.size(), 18U);
  for (const auto& point : points) EXPECT_EQ(point.on.size(), 1U) << point.angle / degree;
}

}  // namespace
}  // namespace fastjoint::stage2
