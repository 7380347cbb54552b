// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/trunk_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

namespace fastjoint::pfem {
namespace {

TEST(TrunkSpace, HasTheCountsOfTheBook) {
  const int expected[] = {4, 8, 12, 17, 23, 30, 38, 47};  // Szabo & Babuska 1991, table of trunk space dimensions
  for (int p = 1; p <= 8; ++p) EXPECT_EQ(trunk_space(p).size(), expected[p - 1]) << "p=" << p;
}

TEST(TrunkSpace, EdgeModesStandWhereEdgeModeSays) {
  for (int p = 2; p <= 8; ++p) {
    const auto modes = trunk_space(p);
    for (int edge = 0; edge < n_local_edges; ++edge)
      for (int k = 2; k <= p; ++k) {
        const Mode& mode = modes[static_cast<std::size_t>(edge_mode(p, edge, k))];
        EXPECT_EQ(mode.degree, k);
        EXPECT_EQ(edge % 2 == 0 ? mode.i : mode.j, k);
        EXPECT_EQ(edge % 2 == 0 ? mode.j : mode.i, edge == 1 || edge == 2 ? 1 : 0);
      }
  }
}

Eigen::VectorXd grid(int n, bool fast) {
  Eigen::VectorXd x(n * n);
  for (int i = 0; i < n * n; ++i) x[i] = -1 + 2.0 * (fast ? i % n : i / n) / (n - 1);
  return x;
}

TEST(TrunkSpace, VertexModesAreAPartitionOfUnity) {
  const auto v = shape_values(8, grid(5, true), grid(5, false));
  EXPECT_LT((v.N.topRows(4).colwise().sum().array() - 1).abs().maxCoeff(), 1e-15);
}

TEST(TrunkSpace, ContainsEveryPolynomialOfItsDegreeAndNotTheNext) {
  for (int p = 1; p <= 8; ++p) {
    const int n = p + 3;
    const Eigen::VectorXd xi = grid(n, true);
    const Eigen::VectorXd eta = grid(n, false);
    const Eigen::MatrixXd N = shape_values(p, xi, eta).N.transpose();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(N);
    const auto distance = [&](int a, int b) {
      const Eigen::VectorXd f = xi.array().pow(a) * eta.array().pow(b);
      return (N * qr.solve(f) - f).norm();
    };
    for (int a = 0; a <= p; ++a) EXPECT_LT(distance(a, p - a), 1e-11) << "p=" << p << " a=" << a;
    EXPECT_GT(distance(p + 1, 0), 1e-4) << "p=" << p;
  }
}

TEST(TrunkSpace, DerivativesAgreeWithDifferences) {
  const double h = 1e-6;
  const Eigen::VectorXd xi = grid(5, true) * 0.97;
  const Eigen::VectorXd eta = grid(5, false) * 0.93;
  const auto v = shape_values(8, xi, eta);
  const Eigen::MatrixXd by_xi =
      (shape_values(8, xi.array() + h, eta).N - shape_values(8, xi.array() - h, eta).N) / (2 * h);
  const Eigen::MatrixXd by_eta =
      (shape_values(8, xi, eta.array() + h).N - shape_values(8, xi, eta.array() - h).N) / (2 * h);
  EXPECT_LT((by_xi - v.dN_dxi).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((by_eta - v.dN_deta).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace fastjoint::pfem
