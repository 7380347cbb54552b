// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/shape_functions.hpp"

#include <gtest/gtest.h>

namespace fastjoint::pfem {
namespace {

class LegendreP : public testing::TestWithParam<int> {};

TEST_P(LegendreP, DerivativesAreOrthonormal) {
  const int p = GetParam();
  const Rule rule = gauss(p + 1);
  const Values v = integrated_legendre(p, rule.x);
  const Eigen::MatrixXd G = v.dN * rule.w.asDiagonal() * v.dN.transpose();
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(p - 1, p - 1);
  EXPECT_LT((G.bottomRightCorner(p - 1, p - 1) - I).norm(), 1e-13 * p);  // p flops a row
  EXPECT_LT(G.topRightCorner(2, p - 1).norm(), 1e-13 * p);               // and orthogonal to the linear ones
}

TEST_P(LegendreP, DerivativesAgreeWithDifferences) {
  const int p = GetParam();
  const double h = 1e-6;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(11, -0.99, 0.99);
  const Eigen::MatrixXd difference =
      (integrated_legendre(p, x.array() + h).N - integrated_legendre(p, x.array() - h).N) / (2 * h);
  EXPECT_LT((difference - integrated_legendre(p, x).dN).cwiseAbs().maxCoeff(), 1e-7);  // h^2 p^5, rounding / h
}

TEST_P(LegendreP, HigherModesVanishAtTheEnds) {
  const int p = GetParam();
  const Values v = integrated_legendre(p, Eigen::Vector2d(-1, 1));
  EXPECT_LT(v.N.bottomRows(p - 1).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(v.N.topRows(2), (Eigen::Matrix2d() << 1, 0, 0, 1).finished());
}

TEST_P(LegendreP, ModesAreEvenOrOdd) {
  const int p = GetParam();
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(7, 0.05, 0.95);
  const Eigen::MatrixXd right = integrated_legendre(p, x).N;
  const Eigen::MatrixXd left = integrated_legendre(p, -x).N;
  for (int k = 2; k <= p; ++k)
    EXPECT_LT((left.row(k) - (k % 2 == 0 ? 1 : -1) * right.row(k)).norm(), 1e-15) << "k=" << k;
}

INSTANTIATE_TEST_SUITE_P(Degrees, LegendreP, testing::Values(2, 3, 5, 8, 12));

TEST(Gauss, IsExactToItsDegree) {
  for (int n = 1; n <= 16; ++n) {
    const Rule rule = gauss(n);
    for (int degree = 0; degree < 2 * n; ++degree)
      EXPECT_NEAR(rule.x.array().pow(degree).matrix().dot(rule.w), degree % 2 == 0 ? 2.0 / (degree + 1) : 0, 1e-13);
    const double beyond = rule.x.array().pow(2 * n).matrix().dot(rule.w);
    EXPECT_GT(2.0 / (2 * n + 1) - beyond, 1e-12) << "n=" << n;
  }
}

}  // namespace
}  // namespace fastjoint::pfem
