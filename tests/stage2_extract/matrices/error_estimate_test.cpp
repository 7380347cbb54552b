// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "common/matrices/stiffness_error.hpp"
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
      if (s > p - 1) continue;  // below degree 6 no rate beyond p - 1 is believed
      const VectorXd values = algebraic(s).head(p);
      EXPECT_NEAR(matrices::extrapolated_error(values, degrees(1, p)) / (values[p - 1] - 7), 1, 10 * remainder) << s;
    }
}

/// The error is estimated as if a singular point of exponent 1 had taken over at the last degree, with differences that
/// fall as p^-8 at most.
TEST(ErrorEstimate, TrustsNoRateBeyondFiveNorDifferencesBeyondEight) {
  const VectorXd five = algebraic(5);
  const double more = (five[7] - 7) / (five[6] - five[7]);
  for (const double base : {0.4, 0.1}) {
    const VectorXd fast = VectorXd::LinSpaced(8, 1, 8).unaryExpr([&](double p) { return std::pow(base, p); });
    const double shown = -2 * std::log(base) / std::log(8.0 / 6),
                 carried = std::pow(7.0 / 8, std::min(shown, 8.0)) / base;
    EXPECT_NEAR(matrices::extrapolated_error(fast, degrees(1, 8)) / (fast[6] - fast[7]), carried * more, 0.01 * carried)
        << base;
  }
}

/// The trunk space alternates: the difference before shows what an accidentally small one hides.
TEST(ErrorEstimate, OfADifferenceThatHappensToBeSmall) {
  const VectorXd cubic = algebraic(3);
  VectorXd values = cubic;
  const double before = cubic[5] - cubic[6], last = (cubic[6] - cubic[7]) / 2;
  values[7] = values[6] - last;
  const double rate = 3 + std::log(2) / std::log(8.0 / 6), carried = before * std::pow(7.0 / 8, rate);
  const VectorXd five = algebraic(5);
  EXPECT_NEAR(matrices::extrapolated_error(values, degrees(1, 8)) / (carried * (five[7] - 7) / (five[6] - five[7])), 1,
              0.01);
  EXPECT_GT(carried, 1.4 * last);
}

TEST(ErrorEstimate, OfFewOrOddValues) {
  EXPECT_TRUE(std::isinf(matrices::extrapolated_error(VectorXd::Ones(1), degrees(8, 8))));
  // s = 3: the sum of (8 / p)^3 above 8
  const VectorXd cubic = algebraic(3);
  const double three = (cubic[7] - 7) / (cubic[6] - cubic[7]);
  EXPECT_NEAR(matrices::extrapolated_error(Eigen::Vector2d(3, 2.5), degrees(7, 8)), 0.5 * three, 1e-3);
  EXPECT_NEAR(matrices::extrapolated_error(Eigen::Vector3d(3.14, 2.5, 2.1), degrees(6, 8)), 0.4 * three, 1e-3);
  EXPECT_GT(matrices::extrapolated_error(Eigen::Vector3d(3, 2.9, 2.5), degrees(6, 8)), 0.4 * three);  // it rises
  // one that does not fall any more, and one that has reached rounding
  EXPECT_GT(matrices::extrapolated_error(Eigen::Vector4d(3, 2.9, 2.8, 2.5), degrees(5, 8)), 0.3 * three);
  EXPECT_DOUBLE_EQ(matrices::extrapolated_error(VectorXd::Constant(8, 3.0), degrees(1, 8)), 3e-13);
}

/// Matrices S + tail(p) E with a known tail: the true error of the last is its tail times E, which the estimate has on
/// the diagonal; off it, E is the product of two fields' errors, which may be in the same direction or across.
TEST(ErrorEstimate, OfMatricesWithAKnownErrorIsThatError) {
  const VectorXd tail = algebraic(3).array() - 7;
  for (const double cosine : {1.0, 0.5, 0.0, -0.5}) {
    const Eigen::Matrix2d E = (Eigen::Matrix2d() << 4, 6 * cosine, 6 * cosine, 9).finished();
    std::vector<Eigen::MatrixXd> S;
    for (Eigen::Index i = 0; i < tail.size(); ++i)
      S.emplace_back((Eigen::Matrix2d() << 200, -50, -50, 300).finished() + tail[i] * E);
    const Eigen::MatrixXd estimate = matrices::stiffness_error(S, degrees(1, 8), 5);
    const Eigen::Matrix2d error = tail[7] * E;
    EXPECT_NEAR(estimate(0, 0) / error(0, 0), 1, 0.01) << cosine;
    EXPECT_NEAR(estimate(1, 1) / error(1, 1), 1, 0.01) << cosine;
    EXPECT_EQ(estimate(0, 1), estimate(1, 0)) << cosine;
    const double bound = tail[7] * 6;  // by Cauchy and Schwarz
    EXPECT_GT(estimate(0, 1), 0.99 * std::abs(error(0, 1))) << cosine;
    EXPECT_GT(estimate(0, 1), 0.1 * bound) << cosine << ": a difference of zero may just pass through it";
    EXPECT_LT(estimate(0, 1), (std::abs(cosine) < 1 ? 0.6 : 1.01) * bound)
        << cosine << ": more is known than the bound";
  }
}

/// Each over its own norm; S that is zero over that of K_cc; what a sheet does not have is left out.
TEST(ErrorEstimate, OfAllMatricesOfASheet) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1), none(0, 0), zero = Eigen::MatrixXd::Zero(1, 1);
  const VectorXi p = degrees(1, 2);
  const auto errors =
      matrices::relative_errors({{2.2 * one, 2 * one}, {3 * one, 4 * one}, {0.9 * one, one}}, p, 8 * one, 5);
  ASSERT_EQ(errors.size(), 3U);
  const double factor = matrices::extrapolated_error(Eigen::Vector2d(3, 2), p);
  EXPECT_NEAR(errors[0].value, factor * 0.2 / 2, 1e-15);
  EXPECT_NEAR(errors[1].value, factor * 1 / 4, 1e-15);
  EXPECT_NEAR(errors[2].value, factor * 0.1, 1e-15);
  EXPECT_EQ(matrices::largest(errors), errors[1].value);
  EXPECT_EQ(matrices::to_text({{"S", 6.1e-5}, {"R", 3e-11}}), "error of S about 6.10e-05, of R below 1e-10");
  const auto of_zero = matrices::relative_errors({{0.4 * one, zero}, {none, none}, {none, none}}, p, 8 * one, 5);
  ASSERT_EQ(of_zero.size(), 1U);
  EXPECT_NEAR(of_zero[0].value, factor * 0.4 / 8, 1e-15);
  for (const auto& error : matrices::relative_errors({{one}, {one}, {one}}, degrees(8, 8), one, 5))
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
