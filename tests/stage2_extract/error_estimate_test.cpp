// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "common/pfem/stiffness_error.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using Eigen::VectorXd;
using Eigen::VectorXi;

VectorXi degrees(int low, int high) { return VectorXi::LinSpaced(high - low + 1, low, high); }

/// 7 + the sum of q^-s over all degrees q above p, for p = 1 .. 8.
VectorXd algebraic(double s) {
  constexpr int far = 100000;
  VectorXd values(8);
  double sum = std::pow(far, 1 - s) / (s - 1);
  for (int q = far; q > 1; --q) {
    sum += std::pow(q, -s);
    if (q <= 9) values[q - 2] = 7 + sum;
  }
  return values;
}

TEST(ErrorEstimate, IsExactForAnAlgebraicSequence) {
  constexpr double remainder = 1e-3;  // of Euler and Maclaurin's formula behind its third term
  for (const double s : {2.0, 3.0, 4.0, 4.9})
    for (const int p : {4, 6, 8}) {
      const VectorXd values = algebraic(s).head(p);
      EXPECT_NEAR(pfem::extrapolated_error(values, degrees(1, p)) / (values[p - 1] - 7), 1, 10 * remainder) << s;
    }
}

/// As if a singular point of exponent 1 had taken over at the last degree.
TEST(ErrorEstimate, TrustsNoRateBeyondFive) {
  const VectorXd fast = VectorXd::LinSpaced(8, 1, 8).unaryExpr([](double p) { return std::pow(0.1, p); });
  const VectorXd five = algebraic(5);
  const double last = five[6] - five[7];
  EXPECT_NEAR(pfem::extrapolated_error(fast, degrees(1, 8)) / (fast[6] - fast[7]), (five[7] - 7) / last, 1e-2);
}

TEST(ErrorEstimate, OfFewOrOddValues) {
  EXPECT_TRUE(std::isinf(pfem::extrapolated_error(VectorXd::Ones(1), degrees(8, 8))));
  // s = 3: the sum of (8 / p)^3 above 8
  const VectorXd cubic = algebraic(3);
  const double three = (cubic[7] - 7) / (cubic[6] - cubic[7]);
  EXPECT_NEAR(pfem::extrapolated_error(Eigen::Vector2d(3, 2.5), degrees(7, 8)), 0.5 * three, 1e-3);
  EXPECT_NEAR(pfem::extrapolated_error(Eigen::Vector3d(3, 2.9, 2.5), degrees(6, 8)), 0.4 * three, 1e-3);
  // one that does not fall any more, and one that has reached rounding
  EXPECT_GT(pfem::extrapolated_error(Eigen::Vector4d(3, 2.9, 2.8, 2.5), degrees(5, 8)), 0.3 * three);
  EXPECT_DOUBLE_EQ(pfem::extrapolated_error(VectorXd::Constant(8, 3.0), degrees(1, 8)), 3e-13);
}

TEST(ErrorEstimate, OfMatrices) {
  Eigen::Matrix2d fine, coarse;
  fine << 2, 1, 1, 2;
  coarse << 2.04, 1.02, 1.02, 2.09;
  const VectorXi p = degrees(1, 2);
  const auto error = pfem::stiffness_error({coarse, fine}, p, 5);
  const double factor = pfem::extrapolated_error(Eigen::Vector2d(2.04, 2), p) / 0.04;
  EXPECT_NEAR(error(1, 1), factor * 0.09, 1e-15);
  const double share = 0.02 / std::sqrt(0.04 * 0.09);  // of what Cauchy and Schwarz allow
  EXPECT_NEAR(error(0, 1), factor * std::sqrt(0.04 * 0.09) * std::hypot(share, 0.15 * std::sqrt(1 - share * share)),
              1e-15);
  EXPECT_EQ(error(0, 1), error(1, 0));
  coarse(0, 1) = coarse(1, 0) = 1;  // passes through zero
  EXPECT_NEAR(pfem::stiffness_error({coarse, fine}, p, 5)(0, 1), factor * 0.15 * 0.06, 1e-15);
}

/// Each over its own norm; S that is zero over that of K_cc; what a sheet does not have is left out.
TEST(ErrorEstimate, OfAllMatricesOfASheet) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1), none(0, 0), zero = Eigen::MatrixXd::Zero(1, 1);
  const VectorXi p = degrees(1, 2);
  const auto errors =
      pfem::relative_errors({{2.2 * one, 2 * one}, {3 * one, 4 * one}, {0.9 * one, one}}, p, 8 * one, 5);
  ASSERT_EQ(errors.size(), 3U);
  const double factor = pfem::extrapolated_error(Eigen::Vector2d(3, 2), p);
  EXPECT_NEAR(errors[0].value, factor * 0.2 / 2, 1e-15);
  EXPECT_NEAR(errors[1].value, factor * 1 / 4, 1e-15);
  EXPECT_NEAR(errors[2].value, factor * 0.1, 1e-15);
  EXPECT_EQ(pfem::largest(errors), errors[1].value);
  EXPECT_EQ(pfem::to_text({{"S", 6.1e-5}, {"R", 3e-11}}), "error of S about 6.10e-05, of R below 1e-10");
  const auto of_zero = pfem::relative_errors({{0.4 * one, zero}, {none, none}, {none, none}}, p, 8 * one, 5);
  ASSERT_EQ(of_zero.size(), 1U);
  EXPECT_NEAR(of_zero[0].value, factor * 0.4 / 8, 1e-15);
  for (const auto& error : pfem::relative_errors({{one}, {one}, {one}}, degrees(8, 8), one, 5))
    EXPECT_TRUE(std::isinf(error.value)) << error.of;
}

/// Entry by entry: the diagonal to a factor, off it mostly a bound.
TEST(ErrorEstimate, BoundsTheTrueErrorOfPanels) {
  for (const auto& [space, nx] : {std::pair{pfem::Space::trunk, 1},
                                  {pfem::Space::trunk, 2},
                                  {pfem::Space::trunk, 3},
                                  {pfem::Space::product, 1},
                                  {pfem::Space::product, 3}}) {
    const auto coarse = test::extract(test::panel(nx, 1, 0, test::in_space(space))).matrices;
    const auto fine = test::extract(test::panel(nx, 1, 2, test::in_space(space))).matrices;
    const auto check = [&](const Eigen::MatrixXd& S, const Eigen::MatrixXd& reference, const Eigen::MatrixXd& error) {
      const VectorXd ratio = (S - reference).diagonal().cwiseAbs().cwiseQuotient(error.diagonal());
      EXPECT_GT(ratio.minCoeff(), 0.1) << pfem::name_of(space) << " " << nx;
      EXPECT_LT((S - reference).cwiseAbs().cwiseQuotient(error).maxCoeff(), 1.5) << pfem::name_of(space) << " " << nx;
    };
    check(coarse.S_ee.back(), fine.S_ee.back(), coarse.S_ee_error);
    check(coarse.S_dd.back(), fine.S_dd.back(), coarse.S_dd_error);
  }
}

}  // namespace
}  // namespace fastjoint
