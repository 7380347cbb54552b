// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/shape_functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/matrices/decompositions.hpp"
#include "tests/support/spaces.hpp"

namespace fastjoint::pfem {
namespace {

TEST(ShapeFunctions, HaveTheCountsOfTheBook) {
  const int expected[] = {4, 8, 12, 17, 23, 30, 38, 47};  // Szabo & Babuska 1991, table of trunk space dimensions
  for (int p = 1; p <= 8; ++p) {
    EXPECT_EQ(modes(Space::trunk, p).size(), expected[p - 1]) << "p=" << p;
    EXPECT_EQ(modes(Space::product, p).size(), 4 * p + (p - 1) * (p - 1)) << "p=" << p;
  }
}

std::set<std::pair<int, int>> factors(Space space, int p) {
  std::set<std::pair<int, int>> result;
  for (const Mode& mode : modes(space, p)) result.insert({mode.i, mode.j});
  return result;
}

TEST(ShapeFunctions, BothSpacesHaveTheSameVerticesAndEdges) {
  EXPECT_EQ(factors(Space::trunk, 1), factors(Space::product, 1));
  for (int p = 1; p <= 8; ++p) {
    const auto trunk = factors(Space::trunk, p), product = factors(Space::product, p);
    EXPECT_EQ(product.size(), modes(Space::product, p).size()) << "each mode once";
    EXPECT_TRUE(std::includes(product.begin(), product.end(), trunk.begin(), trunk.end())) << "p=" << p;
    for (const auto& [i, j] : product)
      EXPECT_TRUE((i >= 2 && j >= 2) || trunk.count({i, j})) << "p=" << p << " " << i << " " << j;
  }
}

class ShapeFunctionsIn : public testing::TestWithParam<Space> {};

TEST_P(ShapeFunctionsIn, EdgeModesStandWhereEdgeModeSays) {
  for (int p = 2; p <= 8; ++p) {
    const auto list = modes(GetParam(), p);
    for (int edge = 0; edge < n_local_edges; ++edge)
      for (int k = 2; k <= p; ++k) {
        const Mode& mode = list[edge_mode(p, edge, k)];
        EXPECT_EQ(mode.degree, k);
        EXPECT_EQ(edge % 2 == 0 ? mode.i : mode.j, k);
        EXPECT_EQ(edge % 2 == 0 ? mode.j : mode.i, edge == 1 || edge == 2 ? 1 : 0);
      }
  }
}

TEST_P(ShapeFunctionsIn, InteriorModesEnterByDegree) {
  for (int p = 2; p <= 8; ++p) {
    const auto high = modes(GetParam(), p);
    std::set<std::pair<int, int>> below;
    for (const Mode& mode : high)
      if (mode.degree < p) below.insert({mode.i, mode.j});
    EXPECT_EQ(below, factors(GetParam(), p - 1)) << "p=" << p;
    for (std::size_t m = edge_mode(p, n_local_edges, 2) + 1; m < high.size(); ++m)
      EXPECT_LE(high[m - 1].degree, high[m].degree) << "p=" << p;
  }
}

Eigen::VectorXd grid(int n, bool fast) {
  Eigen::VectorXd x(n * n);
  for (int i = 0; i < n * n; ++i) x[i] = -1 + 2.0 * (fast ? i % n : i / n) / (n - 1);
  return x;
}

TEST_P(ShapeFunctionsIn, VertexModesAreAPartitionOfUnity) {
  const auto v = shape_values(GetParam(), 8, grid(5, true), grid(5, false));
  EXPECT_LT((v.N.topRows(4).colwise().sum().array() - 1).abs().maxCoeff(), 1e-15);
}

/// Distance of xi^a eta^b from a space, in the points of a grid that tells all its functions apart.
class Distance {
 public:
  Distance(Space space, int p)
      : xi_(grid(p + 3, true)),
        eta_(grid(p + 3, false)),
        N_(shape_values(space, p, xi_, eta_).N.transpose()),
        svd_(matrices::singular_values(N_)) {}
  double operator()(int a, int b) const {
    const Eigen::VectorXd f = xi_.array().pow(a) * eta_.array().pow(b);
    return (N_ * svd_.solve(f, 0) - f).norm();
  }

 private:
  Eigen::VectorXd xi_, eta_;
  Eigen::MatrixXd N_;
  matrices::SingularValues svd_;
};

TEST_P(ShapeFunctionsIn, ContainEveryPolynomialOfTheirDegreeAndNotTheNext) {
  for (int p = 1; p <= 8; ++p) {
    const Distance distance(GetParam(), p);
    for (int a = 0; a <= p; ++a) EXPECT_LT(distance(a, p - a), 1e-11) << "p=" << p << " a=" << a;
    EXPECT_GT(distance(p + 1, 0), 1e-4) << "p=" << p;
    EXPECT_GT(distance(0, p + 1), 1e-4) << "p=" << p;
  }
}

TEST(ShapeFunctions, OfTheProductSpaceContainEveryProductOfPowersThoseOfTheTrunkSpaceDoNot) {
  for (int p = 1; p <= 8; ++p) {
    const Distance product(Space::product, p), trunk(Space::trunk, p);
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b) EXPECT_LT(product(a, b), 1e-11) << "p=" << p << " a=" << a << " b=" << b;
    if (p >= 2) {
      EXPECT_GT(trunk(p, p), 1e-2) << "p=" << p;
    }
  }
}

TEST_P(ShapeFunctionsIn, DerivativesAgreeWithDifferences) {
  const double h = 1e-6;
  const Eigen::VectorXd xi = grid(5, true) * 0.97;
  const Eigen::VectorXd eta = grid(5, false) * 0.93;
  const auto N = [&](double by_xi, double by_eta) {
    return shape_values(GetParam(), 8, xi.array() + by_xi, eta.array() + by_eta).N;
  };
  const auto v = shape_values(GetParam(), 8, xi, eta);
  EXPECT_LT(((N(h, 0) - N(-h, 0)) / (2 * h) - v.dN_dxi).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(((N(0, h) - N(0, -h)) / (2 * h) - v.dN_deta).cwiseAbs().maxCoeff(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Spaces, ShapeFunctionsIn, test::both_spaces(), test::space_tested);

}  // namespace
}  // namespace fastjoint::pfem
