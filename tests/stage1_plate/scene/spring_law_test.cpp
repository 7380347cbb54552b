// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <gtest/gtest.h>

namespace fastjoint {
namespace {

constexpr double E = 1e7, nu = 0.3, d = 0.5;

double modulus(const char* law, double with_E = E, double with_nu = nu) {
  const auto& laws = stage1::spring_laws();
  return laws.at(index_of(laws, law, &stage1::SpringLaw::name)).modulus(with_E, with_nu, d);
}

TEST(SpringLaw, TheDefaultIsEquation29) {
  EXPECT_EQ(stage1::spring_laws().front().name, "plane stress");
  EXPECT_DOUBLE_EQ(modulus("plane stress"), 2 / (1 - nu) * E / d);
}

/// A disk in plane strain is one in plane stress with E / (1 - nu^2) and nu / (1 - nu).
TEST(SpringLaw, PlaneStrainFollowsFromPlaneStress) {
  const double in_strain = modulus("plane stress", E / (1 - nu * nu), nu / (1 - nu));
  EXPECT_NEAR(modulus("plane strain") / in_strain, 1, 1e-15);
}

/// docs/theory.md, section 3.2: kappa = 3 beta / (3 + nu_D) with kappa = k a / E_P gives the elastic disk's B_a.
TEST(SpringLaw, TheSecondHarmonicIsThatOfTheElasticDisk) {
  EXPECT_NEAR(modulus("second harmonic") * (d / 2) / E, 3 / (3 + nu), 1e-15);
}

}  // namespace
}  // namespace fastjoint
