// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of a rim of contact: against integrals summed over points, its slopes against differences.
#include "stage3_nonlinear/interfaces/rim_friction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace fastjoint::stage3::rim_friction_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double stiffness = 700, mu = 0.3;

/// Moments of a disc that is pushed in a direction, and of some waves.
VectorXd moments(const rim::Harmonics& pressures, double direction, std::mt19937& random) {
  std::uniform_real_distribution<double> wave(-1, 1);
  VectorXd m = VectorXd::NullaryExpr(pressures.size(), [&](Index k) { return 0.02 * wave(random) / double(k + 1); });
  return m + 0.1 * (pressures.push(0) * std::cos(direction) + pressures.push(1) * std::sin(direction));
}

RimFriction friction(const CompressionOnlyRim& rim, const VectorXd& m) { return rim_friction(rim, rim.touching(m), m); }

/// Forces of the shears by a sum over many points.
VectorXd summed(const CompressionOnlyRim& rim, const VectorXd& m) {
  const auto& pressures = rim.pressures();
  constexpr int n = 200000;
  Eigen::Vector2d resultant(0, 0);
  for (const bool known : {false, true}) {
    VectorXd forces = VectorXd::Zero(pressures.n_shears());
    for (int i = 0; i < n; ++i) {
      const double angle = pressures.start + (i + 0.5) / n * pressures.sweep;
      const double pressure = rim.stiffness() * std::max(rim.depth(m, angle), 0.0) / n;
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle)), tangent(-normal.y(), normal.x());
      if (!known) resultant += pressure * normal;
      if (known) forces += std::copysign(rim.mu() * pressure, tangent.dot(resultant)) * pressures.shears_at(angle);
    }
    if (!pressures.is_whole()) {  // the other half, mirrored
      const Eigen::Vector2d line(std::cos(pressures.start), std::sin(pressures.start));
      resultant = (line * line.dot(resultant)).eval();
    }
    if (known) return forces;
  }
  return {};
}

const rim::Harmonics whole{5}, half{6, pi, pi};

TEST(RimFriction, IsThePressureTimesItsCoefficientOnBothSidesOfTheForce) {
  std::mt19937 random(1);
  for (const auto& pressures : {whole, half})
    for (const double gap : {0.03, 0.0, -0.01}) {
      const CompressionOnlyRim rim(pressures, stiffness, gap, mu);
      for (const double direction : {0.3, 2.5, 4.0}) {
        const VectorXd m = moments(pressures, direction, random);
        const RimFriction found = friction(rim, m);
        ASSERT_TRUE(found.slips);
        EXPECT_LT((found.forces - summed(rim, m)).norm(), 2e-4 * found.forces.norm()) << direction << " " << gap;
      }
    }
}

TEST(RimFriction, SlopesAreThoseOfDifferences) {
  std::mt19937 random(2);
  for (const auto& pressures : {whole, half})
    for (const double gap : {0.03, 0.0, -0.01, -0.5}) {  // the last sticks
      const CompressionOnlyRim rim(pressures, stiffness, gap, mu);
      for (const double direction : {0.3, 2.5, 4.0}) {
        const VectorXd m = moments(pressures, direction, random);
        const RimFriction found = friction(rim, m);
        EXPECT_EQ(found.slips, gap > -0.1);
        constexpr double h = 1e-7;
        for (Index k = 0; k < m.size(); ++k) {
          const VectorXd step = h * VectorXd::Unit(m.size(), k);
          const VectorXd slope =
              (friction(rim, m + step).forces - friction(rim, m - step).forces) / (2 * h * stiffness);
          EXPECT_LT((slope - found.slopes.col(k)).norm(), 1e-6 * found.slopes.norm()) << k << " " << gap;
        }
      }
    }
}

/// Resultants of pressure and of friction along the force.
std::pair<double, double> resultants(const CompressionOnlyRim& rim, const VectorXd& m) {
  const auto& pressures = rim.pressures();
  const VectorXd p = rim.forces(rim.touching(m), m), t = friction(rim, m).forces;
  return {std::hypot(pressures.push(0).dot(p), pressures.push(1).dot(p)),
          std::hypot(pressures.drag(0).dot(t), pressures.drag(1).dot(t))};
}

TEST(RimFriction, ARimWhoseInterferenceHoldsItSticks) {
  VectorXd m = VectorXd::Zero(whole.size());
  const CompressionOnlyRim rim(whole, stiffness, -0.5, mu);
  EXPECT_TRUE(friction(rim, m).forces.isZero(0));
  for (const double push : {1e-9, 0.01, 0.1}) {
    m[1] = push;
    const auto [pressure, shear] = resultants(rim, m);
    EXPECT_FALSE(friction(rim, m).slips);
    EXPECT_NEAR(shear / pressure, 1, 1e-12);
  }
  m[1] = 0.4;  // mean |sin| is 2 / pi: it slips from p_1 = 4 mu p_0 / pi on
  EXPECT_TRUE(friction(rim, m).slips);
  const auto [pressure, shear] = resultants(rim, m);
  EXPECT_LT(shear, pressure);
}

TEST(RimFriction, CosinePressureDragsByTwoOverPi) {
  VectorXd m = VectorXd::Zero(whole.size());
  m[1] = 0.01;
  const auto [pressure, shear] = resultants(CompressionOnlyRim(whole, stiffness, 0, mu), m);
  EXPECT_NEAR(shear / pressure, 2 / pi * mu, 1e-12);
}

/// Friction turns with the force: it knows no axes.
TEST(RimFriction, TurnsWithTheForce) {
  const CompressionOnlyRim rim(whole, stiffness, 0.001, mu);
  for (const double direction : {0.0, 0.7, 1.6, 3.9}) {
    VectorXd m = VectorXd::Zero(whole.size());
    m[1] = 0.01 * std::cos(direction), m[2] = 0.01 * std::sin(direction);
    const VectorXd t = friction(rim, m).forces;
    EXPECT_NEAR(whole.drag(0).dot(t) * std::sin(direction), whole.drag(1).dot(t) * std::cos(direction), 1e-12);
    const auto [pressure, shear] = resultants(rim, m);
    m[1] = 0.01, m[2] = 0;
    EXPECT_NEAR(shear, resultants(rim, m).second, 1e-10 * pressure);
  }
}

}  // namespace
}  // namespace fastjoint::stage3::rim_friction_test
