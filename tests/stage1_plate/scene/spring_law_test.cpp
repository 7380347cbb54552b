// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/spring_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

constexpr double E = 1e7, nu = 0.3, d = 0.5;

double modulus(const char* law) { return stage1::find_spring_law(law).modulus(E, nu, d); }

TEST(SpringLaw, TheDefaultIsEquation29) {
  EXPECT_EQ(stage1::spring_laws().front().name, "plane stress");
  EXPECT_DOUBLE_EQ(modulus("plane stress"), 2 / (1 - nu) * E / d);
}

/// A disk in plane strain is one in plane stress with E / (1 - nu^2) and nu / (1 - nu).
TEST(SpringLaw, PlaneStrainFollowsFromPlaneStress) {
  const double in_strain = stage1::find_spring_law("plane stress").modulus(E / (1 - nu * nu), nu / (1 - nu), d);
  EXPECT_NEAR(modulus("plane strain") / in_strain, 1, 1e-15);
}

/// docs/theory.md, section 3.2: kappa = 3 beta / (3 + nu_D) with kappa = k a / E_P gives the elastic disk's B_a.
TEST(SpringLaw, TheSecondHarmonicIsThatOfTheElasticDisk) {
  EXPECT_NEAR(modulus("second harmonic") * (d / 2) / E, 3 / (3 + nu), 1e-15);
}

TEST(SpringLaw, NamesOnlyItsOwn) { EXPECT_THROW((void)stage1::find_spring_law("cubic"), std::logic_error); }

}  // namespace
}  // namespace fastjoint
