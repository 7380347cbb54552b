// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/material.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace fastjoint::pfem {
namespace {

const OrthotropicConstants ply = {2e7, 1e6, 1e6, 0.3, 0.3, 0.45, 7e5};

TEST(Material, IsotropicPlaneStressAndStrain) {
  const double E = 200, nu = 0.3;
  const auto stress = elasticity(isotropic(E, nu), 0, Analysis::plane_stress);
  EXPECT_NEAR(stress(0, 0), E / (1 - nu * nu), 1e-11);
  EXPECT_NEAR(stress(0, 1), nu * E / (1 - nu * nu), 1e-11);
  const auto strain = elasticity(isotropic(E, nu), 0, Analysis::plane_strain);
  EXPECT_NEAR(strain(0, 0), E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 1e-11);
  EXPECT_NEAR(strain(0, 1), E * nu / ((1 + nu) * (1 - 2 * nu)), 1e-11);
  EXPECT_NEAR(strain(2, 2), E / (2 * (1 + nu)), 1e-11);
}

TEST(Material, TurningAnIsotropicBodyChangesNothing) {
  for (const auto analysis : {Analysis::plane_stress, Analysis::plane_strain})
    EXPECT_LT((elasticity(isotropic(200, 0.3), 0.7, analysis) - elasticity(isotropic(200, 0.3), 0, analysis)).norm(),
              1e-10);
}

TEST(Material, TurningBy90DegreesSwapsTheAxes) {
  const auto D = elasticity(ply, 0, Analysis::plane_stress);
  const auto turned = elasticity(ply, std::numbers::pi / 2, Analysis::plane_stress);
  EXPECT_NEAR(turned(0, 0), D(1, 1), 1e-7);
  EXPECT_NEAR(turned(1, 1), D(0, 0), 1e-7);
}

/// Young's modulus along x of a turned ply: 1/E_x = c^4/E1 + s^4/E2 + c^2 s^2 (1/G12 - 2 nu12/E1), Jones (2.97).
TEST(Material, OffAxisModulus) {
  const double angle = 0.6;
  const double c2 = std::pow(std::cos(angle), 2), s2 = 1 - c2;
  const double expected = c2 * c2 / ply.E1 + s2 * s2 / ply.E2 + c2 * s2 * (1 / ply.G12 - 2 * ply.nu12 / ply.E1);
  const Eigen::Matrix3d compliance = elasticity(ply, angle, Analysis::plane_stress).inverse();
  EXPECT_NEAR(compliance(0, 0) / expected, 1, 1e-12);
}

TEST(Material, StabilityKnowsItsLimits) {
  EXPECT_TRUE(is_stable(isotropic(1, 0.5), Analysis::plane_stress));
  EXPECT_FALSE(is_stable(isotropic(1, 0.5), Analysis::plane_strain));
  EXPECT_TRUE(is_stable(isotropic(1, 0.4999), Analysis::plane_strain));
  EXPECT_TRUE(is_stable({4, 1, 1, 1.99, 0, 0, 1}, Analysis::plane_stress));  // nu12^2 < E1/E2 = 4
  EXPECT_FALSE(is_stable({4, 1, 1, 2.01, 0, 0, 1}, Analysis::plane_stress));
}

}  // namespace
}  // namespace fastjoint::pfem
