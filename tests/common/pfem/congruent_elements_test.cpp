// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element.hpp"

#include <gtest/gtest.h>

#include "tests/support/meshes.hpp"

namespace fastjoint::pfem::congruent_elements_test {
namespace {

using Eigen::MatrixXd;

const std::vector<Eigen::Matrix3d> soft_and_stiff{Eigen::Matrix3d::Identity(), 3 * Eigen::Matrix3d::Identity()};
constexpr int p = 5;

/// Copies of the curved mesh (arcs within and on the border), each moved to a place of its own.
Mesh copies(int n) {
  const Mesh one = test::curved_mesh();
  Mesh all = one;
  const int nodes = one.n_nodes(), elements = one.n_elements();
  all.nodes.resize(2, n * nodes);
  all.quads.resize(4, n * elements);
  all.thickness.resize(n * elements);
  all.material.resize(n * elements);
  all.arcs.clear();
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d by(3.7 * i, -1e3 / 7 * i);
    all.nodes.middleCols(i * nodes, nodes) = one.nodes.colwise() + by;
    all.quads.middleCols(i * elements, elements) = one.quads.array() + i * nodes;
    all.thickness.segment(i * elements, elements) = one.thickness * (1 + i);
    all.material.segment(i * elements, elements) = one.material;
    for (const auto& arc : one.arcs) all.arcs.push_back({arc.a + i * nodes, arc.b + i * nodes, arc.center + by});
  }
  return all;
}

/// Largest relative difference from integrating every element by itself.
double difference(const Mesh& mesh, const CongruentElements& congruent, const Edges& edges) {
  const ElementStiffness each(Space::trunk, p);
  const auto by_shape = integrate(congruent, mesh, edges, soft_and_stiff, Space::trunk, p);
  double worst = 0;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const MatrixXd K = each(ElementMap(mesh, edges, element), soft_and_stiff[mesh.material[element]], 1);
    const std::size_t shape = congruent.class_of[element];
    worst = std::max(worst, (by_shape[shape] - K).norm() / K.norm());
  }
  return worst;
}

TEST(CongruentElements, IsIntegratedOnceForCopies) {
  const Mesh mesh = copies(20);
  const Edges edges = find_edges(mesh);
  const auto congruent = find_congruent(mesh, edges);
  EXPECT_LT(difference(mesh, congruent, edges), 1e-10) << "rounding of coordinates far from the origin";
  EXPECT_LE(congruent.first.size(), 8U) << "4, or a few more where rounding falls between two steps";
}

/// A millionth of the size, another material, or an arc instead of a chord is another element.
TEST(CongruentElements, TellsWhatDiffers) {
  for (const int change : {0, 1, 2, 3}) {
    Mesh mesh = copies(2);
    if (change == 1) mesh.nodes(0, mesh.quads(2, 4)) += 1e-6;
    if (change == 2) mesh.material[4] = 1;
    if (change == 3) mesh.arcs.pop_back();
    const Edges edges = find_edges(mesh);
    const auto congruent = find_congruent(mesh, edges);
    EXPECT_LT(difference(mesh, congruent, edges), 1e-12) << change;
    if (change == 0) {
      EXPECT_EQ(congruent.first.size(), 4U);
    } else {
      EXPECT_GT(congruent.first.size(), 4U) << change;
    }
  }
}

}  // namespace
}  // namespace fastjoint::pfem::congruent_elements_test
