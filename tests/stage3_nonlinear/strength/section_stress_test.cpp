// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/section_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/rim/angles.hpp"
#include "stage3_nonlinear/strength/section_state.hpp"

namespace fastjoint::stage3::section_stress_test {

/// A hole in a cell whose sections are 20 mm^2 across x and 30 mm^2 across y; the hole takes 8 mm^2.
formats::PlateStresses cell() {
  formats::PlateStresses a;
  a.rim_hole = {"1"};
  a.rim_radius = Eigen::VectorXd::Constant(1, 2);
  a.rim_thickness = Eigen::VectorXd::Constant(1, 2);
  a.bearing_area = Eigen::RowVector2d(8, 8);
  a.section_hole = {"1", "1", "1", "1"};
  a.section_side = {"+x", "-x", "+y", "-y"};
  a.gross_area = Eigen::Vector4d(20, 20, 30, 30);
  a.net_area = Eigen::Vector4d(12, 12, 22, 22);
  return a;
}

/// Forces over the sections of a cell under a uniform stress.
SectionForces uniform(const MeanStress& s, const formats::PlateStresses& a) {
  Eigen::Vector4d N(s[0], s[0], s[1], s[1]), V = Eigen::Vector4d::Constant(s[2]);
  return {N.cwiseProduct(a.gross_area), V.cwiseProduct(a.gross_area)};
}

TEST(SectionStress, BypassOfATensionInAnyDirectionIsThatTension) {
  const auto a = cell();
  for (const double angle : {0.0, 30.0, 45.0, 90.0, -60.0}) {
    const double c = std::cos(angle * rim::degree), s = std::sin(angle * rim::degree);
    for (const double tension : {50.0, -50.0}) {
      const auto forces = uniform(tension * MeanStress(c * c, s * s, s * c), a);
      const Principal found = larger_principal(HoleSections(a, 0).bypass(forces, {0, 0}, 1000));
      EXPECT_NEAR(found.value, tension, 1e-12);
      EXPECT_NEAR(std::remainder(found.direction - angle, 180), 0, 1e-9);
    }
  }
}

/// The fastener's force T bears on one side: it is taken off the tension on the other.
TEST(SectionStress, FastenersAddToOneSide) {
  const auto a = cell();
  const HoleSections sections(a, 0);
  SectionForces forces = uniform({10, 4, 0}, a);
  forces.normal[1] += 300;  // T along +x
  EXPECT_NEAR(sections.bypass(forces, {300, 0}, 1000)[0], 10, 1e-12);
  EXPECT_NEAR(sections.gross(forces, {300, 0}, 1000)[0], 10 + 300 / 20.0, 1e-12);
  EXPECT_NEAR(sections.net(forces, {300, 0}, 1000)[0], (200 + 300) / 12.0, 1e-12);
  forces.normal[2] += 90;  // and along -y
  EXPECT_NEAR(sections.bypass(forces, {300, -90}, 1000)[1], 4, 1e-12);
  EXPECT_NEAR(larger_principal(sections.gross(forces, {300, -90}, 1000)).direction, 0, 1e-9);
}

/// However the forces are turned by a right angle or mirrored, the numbers are the same, and go with it.
TEST(SectionStress, NoAxisIsBetter) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  auto a = cell();
  auto turned = a;
  turned.section_side = {"+y", "-y", "-x", "+x"};
  turned.gross_area << 20, 20, 30, 30;
  for (int i = 0; i < 100; ++i) {
    const SectionForces forces{Eigen::Vector4d::NullaryExpr([&] { return 1000 * uniform(random); }),
                               Eigen::Vector4d::NullaryExpr([&] { return 300 * uniform(random); })};
    const Eigen::Vector2d T(500 * uniform(random), 500 * uniform(random));
    const HoleSections here(a, 0), there(turned, 0);
    const SectionForces as_turned{forces.normal, -forces.shear};
    const auto same = [&](const Principal& one, const Principal& other) {
      EXPECT_NEAR(one.value, other.value, 1e-9);
      EXPECT_NEAR(std::remainder(other.direction - one.direction - 90, 180), 0, 1e-6);
    };
    const Eigen::Vector2d turned_T(-T.y(), T.x());
    same(larger_principal(here.bypass(forces, T, 1)), larger_principal(there.bypass(as_turned, turned_T, 1)));
    same(larger_principal(here.gross(forces, T, 1)), larger_principal(there.gross(as_turned, turned_T, 1)));
    same(largest_tension(here.net(forces, T, 1)), largest_tension(there.net(as_turned, turned_T, 1)));
  }
}

/// Half a hole on a line of symmetry: the shear of its half sections is that of their mirror image with the other sign.
TEST(SectionStress, OnALineOfSymmetryThereIsNoShear) {
  auto a = cell();
  a.bearing_area = Eigen::RowVector2d(4, 8);
  EXPECT_NEAR(larger_principal(HoleSections(a, 0).bypass(uniform({10, 0, 7}, a), {0, 0}, 1000)).value, 10, 1e-12);
}

TEST(SectionStress, ShearThatIsNotKnownMakesTheStressUnknown) {
  const auto a = cell();
  SectionForces forces = uniform({10, 4, 0}, a);
  forces.shear.setConstant(std::nan(""));
  const HoleSections sections(a, 0);
  EXPECT_TRUE(std::isinf(larger_principal(sections.bypass(forces, {0, 0}, 1)).value));
  const SectionState state = section_state(sections, {forces, forces}, {0, 0}, 1, 0.01, 30);
  for (const double each : {state.bypass_load, state.bypass_error, state.bypass_across, state.net_stress})
    EXPECT_TRUE(std::isinf(each)) << each;
}

}  // namespace fastjoint::stage3::section_stress_test
