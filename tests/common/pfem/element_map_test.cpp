// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "tests/support/meshes.hpp"

namespace fastjoint::pfem {
namespace {

TEST(ElementMap, JacobianAgreesWithDifferences) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  const double h = 1e-6;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const ElementMap map(mesh, edges, element);
    for (const double xi : {-0.9, 0.2})
      for (const double eta : {-0.3, 0.8}) {
        const Eigen::Matrix2d J = map.jacobian(xi, eta);
        EXPECT_LT(((map.point(xi + h, eta) - map.point(xi - h, eta)) / (2 * h) - J.col(0)).norm(), 1e-8);
        EXPECT_LT(((map.point(xi, eta + h) - map.point(xi, eta - h)) / (2 * h) - J.col(1)).norm(), 1e-8);
      }
  }
}

TEST(ElementMap, NeighboursShareTheirEdgePointByPoint) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  const ElementMap first(mesh, edges, 0);   // its right edge is the arc from node 1 to node 4
  const ElementMap second(mesh, edges, 1);  // its bottom edge is the same arc from node 4 to node 1
  for (const double s : {-1.0, -0.4, 0.3, 1.0}) EXPECT_LT((first.point(1, s) - second.point(-s, -1)).norm(), 1e-14);
}

TEST(ElementMap, AreaOfARingSectorIsExact) {
  Mesh mesh;
  mesh.nodes.resize(2, 4);
  mesh.nodes << 1, 3, 0, 0, 0, 0, 3, 1;
  mesh.quads = Eigen::Vector4i(0, 1, 2, 3);
  mesh.arcs = {{1, 2, {0, 0}}, {3, 0, {0, 0}}};
  const ElementMap map(mesh, find_edges(mesh), 0);
  const Rule rule = gauss(16);
  double area = 0;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) area += rule.w[i] * rule.w[j] * map.jacobian(rule.x[i], rule.x[j]).determinant();
  EXPECT_NEAR(area, std::numbers::pi / 4 * (9 - 1), 1e-13);
  EXPECT_TRUE(map.is_curved());
}

TEST(ElementMap, FoldedElementHasANegativeJacobianRatio) {
  Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  for (int element = 0; element < 4; ++element) EXPECT_GT(jacobian_ratio(ElementMap(mesh, edges, element)), 0.3);
  mesh.nodes.col(4) << -0.2, 1.1;
  EXPECT_LT(jacobian_ratio(ElementMap(mesh, edges, 0)), 0);
}

}  // namespace
}  // namespace fastjoint::pfem
