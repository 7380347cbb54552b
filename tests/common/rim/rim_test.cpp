// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/rim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fastjoint::rim {
namespace {

using Eigen::Vector2d;
using pfem::Edges;
using pfem::Mesh;
using pfem::SideRule;
constexpr double pi = std::numbers::pi;

/// A ring of three sectors whose rays avoid the axes, from radius 1 to 2, turned by 0.3.
Mesh ring() {
  Mesh mesh;
  mesh.nodes.resize(2, 6);
  mesh.quads.resize(4, 3);
  for (int i = 0; i < 3; ++i) {
    const Vector2d ray(std::cos(0.3 + 2 * pi * i / 3), std::sin(0.3 + 2 * pi * i / 3));
    mesh.nodes.col(i) = ray;
    mesh.nodes.col(3 + i) = 2 * ray;
    mesh.quads.col(i) << i, 3 + i, 3 + (i + 1) % 3, (i + 1) % 3;
    mesh.arcs.push_back({i, (i + 1) % 3, {0, 0}});
    mesh.arcs.push_back({3 + i, 3 + (i + 1) % 3, {0, 0}});
  }
  return mesh;
}

TEST(Angles, AreWrappedToHalfATurnEitherWay) {
  EXPECT_EQ(wrapped(-pi), -pi);
  EXPECT_EQ(wrapped(pi), -pi) << "a half-open interval";
  EXPECT_LT(wrapped(std::nextafter(-pi, -4)), pi);
  EXPECT_NEAR(wrapped(7 * pi + 0.25), 0.25 - pi, 1e-14);
  EXPECT_EQ(wrapped(0.5), 0.5);
}

TEST(Rim, IsFoundByCentreAndRadius) {
  const Mesh mesh = ring();
  const Edges edges = find_edges(mesh);
  const auto rim_at = [&](const Vector2d& center, double radius) { return find_rim(mesh, edges, center, radius); };
  const Rim inner = rim_at({0, 0}, 1);
  EXPECT_EQ(inner.sides.size(), 3U);
  EXPECT_TRUE(rim_at({0, 0}, 1.5).sides.empty());
  EXPECT_TRUE(rim_at({0.1, 0}, 1).sides.empty());
  EXPECT_TRUE(rim_at({0, 0.1}, 1).sides.empty());
  EXPECT_TRUE(rim_at({1e-7, -1e-7}, 1).sides == inner.sides) << "but for rounding";
}

/// int cos^2 over the bearing half is pi/2 r; the drag's resultant is r along the bearing direction and 0 across.
TEST(Rim, CosineBearingIntegratesExactlyAcrossItsJumps) {
  const Mesh mesh = ring();
  const Edges edges = find_edges(mesh);
  for (const Vector2d& d : {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)}) {
    double contact = 0;
    Vector2d drag(0, 0);
    for (const auto& side : find_rim(mesh, edges, {0, 0}, 1).sides) {
      const SideRule rule = rim_rule(mesh, edges, side, 8);
      for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
        const auto at = cosine_bearing(-rule.normal.col(q), d);
        contact += rule.ds[q] * at.contact * at.contact;
        drag += rule.ds[q] * at.contact * at.tangent;
      }
    }
    EXPECT_NEAR(contact, pi / 2, 1e-13);
    EXPECT_LT((drag - d).norm(), 1e-13);
  }
}

TEST(Rim, DragIsTangentialAndForward) {
  for (double theta = -1.5; theta < 1.5; theta += 0.37) {
    const Vector2d n(std::cos(theta), std::sin(theta));
    const auto at = cosine_bearing(n, {1, 0});
    EXPECT_NEAR(at.contact, std::cos(theta), 1e-15);
    EXPECT_NEAR(at.tangent.dot(n), 0, 1e-14);
    EXPECT_NEAR(at.tangent.x(), std::abs(std::sin(theta)), 1e-14);
  }
  EXPECT_EQ(cosine_bearing({-0.6, 0.8}, {1, 0}).contact, 0);
}

}  // namespace
}  // namespace fastjoint::rim
