// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/compression_only_rim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fastjoint::stage3::compression_only_rim_test {
namespace {

constexpr double stiffness = 3;

/// Force on each moment by a quadrature of what the springs transmit.
VectorXd by_quadrature(const CompressionOnlyRim& rim, const VectorXd& m) {
  constexpr int n = 40000;
  const auto& [highest, start, sweep] = rim.pressures();
  VectorXd sum = VectorXd::Zero(m.size());
  for (int i = 0; i < n; ++i) {
    const double angle = start + sweep * (i + 0.5) / n;
    sum += std::max(rim.depth(m, angle), 0.0) * rim.pressures().at(angle);
  }
  return stiffness / n * sum;
}

VectorXd random_moments(const CompressionOnlyRim& rim, std::mt19937& random) {
  std::normal_distribution<double> normal;
  VectorXd m(rim.size());
  for (Index k = 0; k < m.size(); ++k) m[k] = normal(random) / (1.0 + double(k * k) / 10);
  return m;
}

TEST(CompressionOnlyRim, ForcesAreThoseOfAQuadrature) {
  std::mt19937 random(1);
  for (const rim::Harmonics& pressures :
       {rim::Harmonics{6}, rim::Harmonics{8, -rim::full_turn / 4, rim::full_turn / 2}})
    for (int i = 0; i < 50; ++i) {
      const CompressionOnlyRim rim(pressures, stiffness, 0.2 * i - 3);
      const VectorXd m = random_moments(rim, random);
      EXPECT_LT((rim.forces(rim.touching(m), m) - by_quadrature(rim, m)).cwiseAbs().maxCoeff(), 1e-6) << "rim " << i;
    }
}

TEST(CompressionOnlyRim, ShareIsTheDerivativeOfTheForces) {
  std::mt19937 random(2);
  constexpr double step = 1e-6;
  for (int i = 0; i < 20; ++i) {
    const CompressionOnlyRim rim({6}, stiffness, 0.1 * i - 1);
    const VectorXd m = random_moments(rim, random), direction = random_moments(rim, random);
    const auto force = [&](const VectorXd& at) { return rim.forces(rim.touching(at), at); };
    const VectorXd difference = (force(m + step * direction) - force(m - step * direction)) / (2 * step);
    EXPECT_LT((stiffness * rim.touching(m).gram * direction - difference).cwiseAbs().maxCoeff(), 1e-6) << "rim " << i;
  }
}

TEST(CompressionOnlyRim, AllAroundItIsSpringsThatAlsoPullLessTheGap) {
  const CompressionOnlyRim tight({4}, stiffness, -10), open({4}, stiffness, 10);
  std::mt19937 random(3);
  const VectorXd m = random_moments(tight, random);
  const VectorXd expected = stiffness * (m + 10 * VectorXd::Unit(m.size(), 0));
  EXPECT_LT((tight.forces(tight.touching(m), m) - expected).norm(), 1e-14);
  EXPECT_EQ(open.forces(open.touching(m), m).norm(), 0);
  EXPECT_TRUE(open.touching(m).arcs.empty());
}

/// A disc pushed by d along x in a rigid sheet: w = d cos(theta) touches where it exceeds the gap.
TEST(CompressionOnlyRim, EndsOfContactAreExact) {
  constexpr double d = 2, gap = 0.5;
  const CompressionOnlyRim rim({9}, stiffness, gap);
  VectorXd m = VectorXd::Zero(rim.size());
  m[1] = d / std::sqrt(2);
  const auto arcs = rim.touching(m).arcs;
  ASSERT_EQ(arcs.size(), 2U) << "the rim starts at 0, inside the arc";
  EXPECT_NEAR(arcs[0].to, std::acos(gap / d), 1e-14);
  EXPECT_NEAR(arcs[1].from, rim::full_turn - std::acos(gap / d), 1e-14);
  EXPECT_NEAR(rim::wrapped(rim.deepest(m)), 0, 1e-12);
  EXPECT_NEAR(rim.depth(m, 0), d - gap, 1e-15);
}

/// Forces and their energy would jump if arcs and openings thinner than the samples were not seen.
TEST(CompressionOnlyRim, ArcsAndOpeningsBetweenSamplesAreFound) {
  constexpr double thin = 1e-6;
  for (const double turned : {0.0, 0.01, 0.05, 0.2, 6.2}) {
    CompressionOnlyRim rim({9}, stiffness, 2 * (1 - thin));  // touches by w = 2 cos(theta - turned) at one place
    VectorXd m = VectorXd::Zero(rim.size());
    m.segment(1, 2) << std::sqrt(2) * std::cos(turned), std::sqrt(2) * std::sin(turned);
    double touching = 0;
    for (const auto& arc : rim.touching(m).arcs) touching += arc.to - arc.from;
    EXPECT_NEAR(touching, 2 * std::acos(1 - thin), 1e-9) << turned;
    rim = CompressionOnlyRim({9}, stiffness, -2 * (1 - thin));  // opens at the opposite place
    touching = 0;
    for (const auto& arc : rim.touching(m).arcs) touching += arc.to - arc.from;
    EXPECT_NEAR(touching, rim::full_turn - 2 * std::acos(1 - thin), 1e-9) << turned;
  }
}

}  // namespace
}  // namespace fastjoint::stage3::compression_only_rim_test
