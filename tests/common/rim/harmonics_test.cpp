// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/harmonics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fastjoint::rim {
namespace {

const Harmonics kinds[] = {{5}, {5, -full_turn / 4, full_turn / 2}, {6, 0, full_turn / 4}, {7, 0.3, 2.1}};

/// Integral over an angle range of the products of rows with columns by the trapezoidal rule, exact to rounding for
/// whole waves, else to 1e-9.
template <class Rows>
Eigen::MatrixXd integral_of_products(const Harmonics& a, double from, double to, Rows rows) {
  constexpr int n = 100000;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows(from).size(), a.size());
  for (int i = 0; i <= n; ++i) {
    const double angle = from + (to - from) * i / n;
    sum += (i == 0 || i == n ? 0.5 : 1.0) * rows(angle) * a.at(angle).transpose();
  }
  return sum * (to - from) / n;
}

/// Derivatives of all pressures by the angle.
Eigen::VectorXd slopes(const Harmonics& a, double angle) {
  return Eigen::VectorXd::NullaryExpr(
      a.size(), [&](Eigen::Index k) { return a.sum_at(Eigen::VectorXd::Unit(a.size(), k), angle).second; });
}

TEST(Harmonics, AreOrthonormalInTheMeanOverTheirRim) {
  for (const auto& a : kinds) {
    const Eigen::MatrixXd mean = a.products({{{a.start, a.start + a.sweep}}}) / a.sweep;
    EXPECT_LT((mean - Eigen::MatrixXd::Identity(a.size(), a.size())).cwiseAbs().maxCoeff(), 1e-14) << a.sweep;
  }
}

TEST(Harmonics, IntegralsOfProductsAreThoseOfAQuadrature) {
  for (const auto& a : kinds)
    for (const double from : {0.0, 0.4}) {
      const double low = a.start + from, middle = a.start + 0.5 * a.sweep, high = a.start + 0.7 * a.sweep;
      const std::vector<SignedRange> pieces{{low, middle}, {middle, high, -1}};
      const auto difference = [&](auto rows) {
        return (integral_of_products(a, low, middle, rows) - integral_of_products(a, middle, high, rows)).eval();
      };
      const auto off = [](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) { return (x - y).cwiseAbs().maxCoeff(); };
      const auto pressures = [&](double angle) { return a.at(angle); };
      const auto shears = [&](double angle) { return a.shears_at(angle); };
      EXPECT_LT(off(a.products(pieces), difference(pressures)), 1e-7) << a.sweep;
      EXPECT_LT(off(a.shear_products(pieces), difference(shears)), 1e-7) << a.sweep;
    }
}

TEST(Harmonics, SumsOfShearsAreThoseOfTheirValues) {
  for (const auto& a : kinds) {
    const Eigen::VectorXd amounts = Eigen::VectorXd::LinSpaced(a.n_shears(), -1, 2);
    for (const double angle : {-1.3, 0.2, 2.9})
      EXPECT_NEAR(a.shear_sum_at(amounts, angle), amounts.dot(a.shears_at(angle)), 1e-13) << a.sweep;
  }
}

TEST(Harmonics, SlopesAreDerivatives) {
  constexpr double step = 1e-6;
  for (const auto& a : kinds) {
    const Eigen::VectorXd difference = (a.at(1 + step) - a.at(1 - step)) / (2 * step);
    EXPECT_LT((slopes(a, 1) - difference).cwiseAbs().maxCoeff(), 1e-8) << a.sweep;
  }
}

TEST(Harmonics, OfPartsMeetLinesOfSymmetryLevelAndHaveTheWavesOfAWholeRim) {
  const Harmonics half{5, -full_turn / 4, full_turn / 2}, quarter{6, 0, full_turn / 4};
  EXPECT_EQ(Harmonics{5}.size(), 11);
  EXPECT_EQ(half.size(), 6);
  EXPECT_EQ(quarter.size(), 4);
  for (const auto& a : {half, quarter})
    for (const double end : {a.start, a.start + a.sweep}) EXPECT_LT(slopes(a, end).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_NEAR(half.at(0.3)[5], std::sqrt(2) * std::cos(5 * (0.3 + full_turn / 4)), 1e-14);
}

}  // namespace
}  // namespace fastjoint::rim
