// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fastjoint::pfem {
namespace {

using Eigen::Vector2d;

TEST(Curve, EndsAreItsEnds) {
  const Vector2d a(3, 1), b(1, 3), center(1, 1);
  for (const Curve& c : {Curve::line(a, b), Curve::arc(a, b, center)}) {
    EXPECT_LT((c.point(-1) - a).norm(), 1e-15);
    EXPECT_LT((c.point(1) - b).norm(), 1e-15);
  }
}

TEST(Curve, ArcIsParametrisedByAngle) {
  const Curve c = Curve::arc({2, 0}, {0, 2}, {0, 0});
  EXPECT_NEAR(c.sweep(), std::numbers::pi / 2, 1e-15);
  for (const double s : {-0.7, 0.0, 0.4}) {
    const double angle = (1 + s) * std::numbers::pi / 4;
    EXPECT_LT((c.point(s) - 2 * Vector2d(std::cos(angle), std::sin(angle))).norm(), 1e-15);
  }
}

TEST(Curve, TakesTheShorterArcAcrossTheCutOfAtan2) {
  const Vector2d center(5, -2);
  const Vector2d a = center + 2 * Vector2d(std::cos(3.0), std::sin(3.0));
  const Vector2d b = center + 2 * Vector2d(std::cos(-3.0), std::sin(-3.0));
  EXPECT_NEAR(Curve::arc(a, b, center).sweep(), 2 * std::numbers::pi - 6, 1e-14);
  EXPECT_NEAR(Curve::arc(b, a, center).sweep(), 6 - 2 * std::numbers::pi, 1e-14);
}

TEST(Curve, DerivativeAgreesWithDifferences) {
  const double h = 1e-6;
  for (const Curve& c : {Curve::line({0, 1}, {2, 5}), Curve::arc({1, 0}, {0, -1}, {0, 0})})
    for (const double s : {-0.8, 0.1, 0.9})
      EXPECT_LT(((c.point(s + h) - c.point(s - h)) / (2 * h) - c.derivative(s)).norm(), 1e-9);
}

}  // namespace
}  // namespace fastjoint::pfem
