// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/mesh.hpp"

#include <gtest/gtest.h>

#include "common/pfem/shape_functions.hpp"
#include "tests/support/meshes.hpp"

namespace fastjoint::pfem {
namespace {

TEST(Boundary, NormalsOfAClosedElementSumToZeroAndGiveItsArea) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  double area = 0;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const SideRule rule = side_rule(mesh, edges, {element, edge}, 4);
      sum += rule.normal * rule.ds;
      area += (rule.x.cwiseProduct(rule.normal) * rule.ds).sum() / 2;  // divergence theorem for the field x / 2
    }
    EXPECT_LT(sum.norm(), 1e-13);
  }
  // the border's arc is hollow
  const double bulge = 0.2, half_chord = std::hypot(0, 1.3) / 2;
  const double radius = (half_chord * half_chord + bulge * bulge) / (2 * bulge);
  const double angle = std::asin(half_chord / radius);
  EXPECT_NEAR(area, 4 - radius * radius * (angle - std::sin(angle) * std::cos(angle)), 1e-12);
}

TEST(Boundary, TracesAreThoseOfTheElement) {
  const Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  for (int edge = 0; edge < n_local_edges; ++edge) {
    const SideRule rule = side_rule(mesh, edges, {0, edge}, 8);
    EXPECT_EQ(rule.modes.size(), 9U);
    const auto gauss_points = rule.ds.size();
    Eigen::VectorXd s(gauss_points);  // recovered from the position, since the edges are straight
    const auto [first, second] = natural_ends(edge);
    const Eigen::Vector2d a = mesh.nodes.col(mesh.quads(first, 0)), b = mesh.nodes.col(mesh.quads(second, 0));
    for (Eigen::Index q = 0; q < gauss_points; ++q)
      s[q] = 2 * (rule.x.col(q) - a).dot(b - a) / (b - a).squaredNorm() - 1;
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(gauss_points);
    const auto all = edge == 0   ? shape_values(Space::product, 8, s, -one)
                     : edge == 1 ? shape_values(Space::product, 8, one, s)
                     : edge == 2 ? shape_values(Space::product, 8, s, one)
                                 : shape_values(Space::product, 8, -one, s);
    Eigen::MatrixXd rest = all.N;
    for (std::size_t m = 0; m < rule.modes.size(); ++m) {
      EXPECT_LT((all.N.row(rule.modes[m]) - rule.N.row(m)).norm(), 1e-13);
      rest.row(rule.modes[m]).setZero();
    }
    EXPECT_LT(rest.norm(), 1e-13);
  }
}

TEST(Boundary, BreaksIntegrateAJumpExactly) {
  const Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  const SideRule rule = side_rule(mesh, edges, {0, 0}, 1, {-0.2, 0.5});  // the bottom edge, from x = 0 to 0.9
  double sum = 0;
  for (Eigen::Index q = 0; q < rule.ds.size(); ++q)
    if (rule.x(0, q) > 0.45 * 0.8 && rule.x(0, q) < 0.45 * 1.5) sum += rule.ds[q];
  EXPECT_NEAR(sum, 0.45 * 0.7, 1e-14);
}

}  // namespace
}  // namespace fastjoint::pfem
