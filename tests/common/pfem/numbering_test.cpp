// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/numbering.hpp"

#include <gtest/gtest.h>

#include <set>

#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/spaces.hpp"

namespace fastjoint::pfem {
namespace {

class NumberingIn : public testing::TestWithParam<Space> {};

TEST(Numbering, CountsVerticesEdgesAndInteriors) {
  const Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  EXPECT_EQ(edges.size(), 12);
  const Numbering trunk = number_by_degree(mesh, edges, Space::trunk, 8);
  EXPECT_EQ(trunk.n_functions[1], 9);
  EXPECT_EQ(trunk.n_functions[8], 9 + 7 * 12 + 15 * 4);
  const Numbering product = number_by_degree(mesh, edges, Space::product, 8);
  for (int k = 1; k <= 8; ++k) EXPECT_EQ(product.n_functions[k], 9 + (k - 1) * 12 + (k - 1) * (k - 1) * 4) << "k=" << k;
}

TEST_P(NumberingIn, DegreesAreLeadingBlocks) {
  const Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  const auto list = modes(GetParam(), 8);
  const Numbering n = number_by_degree(mesh, edges, GetParam(), 8);
  std::set<int> all;
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (std::size_t m = 0; m < list.size(); ++m) {
      const int f = n.function(m, element);
      const std::size_t degree = list[m].degree;
      EXPECT_GE(f, n.n_functions[degree - 1]);
      EXPECT_LT(f, n.n_functions[degree]);
      all.insert(f);
    }
  EXPECT_EQ(all.size(), n.n_functions.back());
}

TEST_P(NumberingIn, ALowerDegreeHasTheSameNumbers) {
  const Mesh mesh = test::distorted_mesh();
  const Edges edges = find_edges(mesh);
  const auto list = modes(GetParam(), 8);
  const Numbering high = number_by_degree(mesh, edges, GetParam(), 8);
  for (int p = 1; p < 8; ++p) {
    const Numbering low = number_by_degree(mesh, edges, GetParam(), p);
    Eigen::Index local = 0;
    const auto low_list = modes(GetParam(), p);
    for (const auto& mode : low_list) {
      const auto same = [&](const Mode& m) { return m.i == mode.i && m.j == mode.j; };
      const auto at = std::find_if(list.begin(), list.end(), same) - list.begin();
      EXPECT_EQ(low.function.row(local), high.function.row(at));
      EXPECT_EQ(low.sign.row(local++), high.sign.row(at));
    }
  }
}

/// Every global function must have one trace on a shared edge: odd modes change sign where an element sees it reversed.
TEST_P(NumberingIn, FunctionsAreContinuousAcrossEdges) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  const Numbering n = number_by_degree(mesh, edges, GetParam(), 8);
  for (const double s : {-0.7, 0.25}) {
    // right edge of element 0 against bottom of element 1, which runs the other way
    const auto a = shape_values(GetParam(), 8, Eigen::VectorXd::Constant(1, 1), Eigen::VectorXd::Constant(1, s)).N;
    const auto b = shape_values(GetParam(), 8, Eigen::VectorXd::Constant(1, -s), Eigen::VectorXd::Constant(1, -1)).N;
    Eigen::VectorXd from_a = Eigen::VectorXd::Zero(n.n_functions.back());
    Eigen::VectorXd from_b = from_a;
    for (Eigen::Index m = 0; m < a.rows(); ++m) {
      from_a[n.function(m, 0)] += n.sign(m, 0) * a(m, 0);
      from_b[n.function(m, 1)] += n.sign(m, 1) * b(m, 0);
    }
    EXPECT_GT(from_a.cwiseAbs().sum(), 1);
    EXPECT_LT((from_a - from_b).cwiseAbs().maxCoeff(), 1e-14);
  }
  EXPECT_EQ(n.sign.minCoeff(), -1);  // the mesh does have reversed edges
}

INSTANTIATE_TEST_SUITE_P(Spaces, NumberingIn, test::both_spaces(), test::space_tested);

/// Every kind of degree of freedom, and the sign of an odd edge mode, reach the element as the numbering has them.
TEST(Numbering, GivesTheDegreesOfFreedomOfAnElement) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  const Numbering numbering = number_by_degree(mesh, edges, Space::trunk, 5);
  Eigen::Matrix2Xi dofs(2, numbering.n_functions.back());
  for (int i = 0; i < dofs.size(); ++i)
    dofs(i % 2, i / 2) = i % 3 == 0 ? i : i % 3 == 1 ? fixed_dof : controlled_dof(i);
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const auto all = element_dofs(numbering, dofs, element);
    const auto n = numbering.function.rows();
    for (Eigen::Index i = 0; i < 2 * n; ++i) {
      const int function = numbering.function(i % n, element), at = 2 * function + (i < n ? 0 : 1);
      EXPECT_EQ(is_free(all.dof[i]), at % 3 == 0);
      EXPECT_EQ(is_controlled(all.dof[i]), at % 3 == 2);
      const int shown = is_free(all.dof[i])         ? all.dof[i]
                        : is_controlled(all.dof[i]) ? controlled_index(all.dof[i])
                                                    : at;
      EXPECT_EQ(shown, at);
      EXPECT_EQ(all.sign[i], numbering.sign(i % n, element));
    }
  }
}

}  // namespace
}  // namespace fastjoint::pfem
