// SPDX-License-Identifier: GPL-3.0-or-later
// Stresses at rims: against resultants, rigid motions, closed forms, and the finite element stress as it comes.
#include "stage2_extract/stresses/rim_stress.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "stage1_plate/run/solve.hpp"
#include "stage2_extract/stresses/stresses.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/rim_methods.hpp"
#include "tests/support/spaces.hpp"

namespace fastjoint {
namespace {

using Eigen::Index;
using formats::PlateMatrices;

class RimStress : public testing::TestWithParam<pfem::Space> {
 protected:
  /// The member of a scene that chooses the space tested.
  static std::string space() { return test::in_space(GetParam()); }
};

/// Two sprung holes and an open one in a row, nothing held along x.
std::string strap(const std::string& more = "") {
  return test::grid_scene({0, 1, 2, 3}, {0, 1},
                          {{"a", 0.5, 0.5, 0.125, 1}, {"b", 1.5, 0.55, 0.15, 1}, {"o", 2.5, 0.5, 0.2, 1, false}},
                          fmt::format(R"(, "supports": [{{"on": "bottom", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}},
                 {{"id": "T", "on": "left", "direction": "x", "kind": "traction"}}]{})",
                                      more));
}

/// Force along x on the disc of a whole rim by the pressure at its points: -int sigma_rr n_x t ds, by the trapezoidal
/// rule, which converges exponentially around a circle.
double disc_force(const formats::PlateStresses& a, Index rim, Index column) {
  double force = 0;
  const Index n = a.rim_start[rim + 1] - a.rim_start[rim];
  for (Index k = a.rim_start[rim]; k < a.rim_start[rim + 1]; ++k)
    force -= a.sigma_rr.back()(k, column) * std::cos(a.angle[k] * rim::full_turn / 360);
  constexpr double thickness = 0.1;
  return force * thickness * a.rim_radius[rim] * rim::full_turn / static_cast<double>(n);
}

TEST_P(RimStress, PressureHasTheForceOfTheStiffnessMatrix) {
  const PlateMatrices a = test::extract(strap(space())).matrices;
  ASSERT_EQ(a.n_cases(), 1 + 2 + 4 + 1);
  const double largest = a.S_dd.back().cwiseAbs().maxCoeff();
  for (Index rim = 0; rim < 2; ++rim) {
    EXPECT_NEAR(disc_force(a.stresses, rim, 0), a.S_ed.back()(0, rim), 1e-6 * largest);
    for (Index disc = 0; disc < 2; ++disc)
      EXPECT_NEAR(disc_force(a.stresses, rim, 1 + disc), a.S_dd.back()(rim, disc), 1e-6 * largest);
    EXPECT_NEAR(disc_force(a.stresses, rim, 7), a.T_d.back()(rim, 0), 1e-6);
  }
}

TEST_P(RimStress, MovingTheWholeSheetStressesNothing) {
  const PlateMatrices a = test::extract(strap(space())).matrices;
  const Eigen::VectorXd together = Eigen::VectorXd::Ones(3);
  for (const auto* sigma : {&a.stresses.sigma_rr.back(), &a.stresses.sigma_tt.back(), &a.stresses.section_force.back()})
    EXPECT_LT((sigma->leftCols(3) * together).cwiseAbs().maxCoeff(), 1e-9 * sigma->cwiseAbs().maxCoeff());
}

TEST_P(RimStress, FreeRimsCarryNoTraction) {
  const auto a = test::extract(strap(space())).matrices.stresses;
  const Index first = a.rim_start[2], n = a.rim_start[3] - first;
  EXPECT_EQ(a.sigma_rr.back().middleRows(first, n).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(a.sigma_rt.back().middleRows(first, n).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(a.sigma_tt.back().middleRows(first, n).cwiseAbs().maxCoeff(), 1);
}

TEST_P(RimStress, FrictionIsTheCosineOnItsBearingHalf) {
  const auto a = test::extract(strap(space())).matrices;
  for (Index k = 0; k < a.stresses.rim_start[1]; ++k) {
    const double theta = a.stresses.angle[k] * rim::full_turn / 360;
    const double c = std::cos(theta);
    // Towards theta = 0 on both sides; the rim's outward normal is -n, so the shear stress is minus the traction.
    const double along = std::abs(std::sin(theta)) < 1e-12 ? 0 : (c > 1e-12 ? c : 0) * (std::sin(theta) > 0 ? 1 : -1);
    EXPECT_NEAR(a.stresses.sigma_rt.back()(k, 3), along, 1e-12) << a.stresses.angle[k];
    EXPECT_EQ(a.stresses.sigma_rt.back()(k, 0), 0);
  }
}

TEST_P(RimStress, HalfModelEqualsTheWhole) {
  const std::string whole_text = test::grid_scene({0, 1}, {-0.5, 0.5}, {{"a", 0.5, 0, 0.15, 1}},
                                                  R"(, "supports": [{"on": "left", "fix": ["x"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])" +
                                                      space());
  const std::string half_text =
      test::grid_scene({0, 1}, {0, 0.5}, {{"a", 0.5, 0, 0.15, 1}},
                       R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])" +
                           space());
  const auto whole = test::extract(whole_text).matrices.stresses;
  const auto half = test::extract(half_text).matrices.stresses;
  ASSERT_EQ(half.angle.size(), 37);
  ASSERT_EQ(whole.angle.size(), 72);
  EXPECT_DOUBLE_EQ(half.angle[36], 180);
  for (Index k = 0; k < 37; ++k) {
    EXPECT_NEAR(whole.angle[k], half.angle[k], 1e-9);
    EXPECT_NEAR(whole.sigma_tt.back()(k, 3), half.sigma_tt.back()(k, 3) / 2, 1e-7) << "half the sheet, the same force";
    EXPECT_NEAR(whole.sigma_rr.back()(k, 0), half.sigma_rr.back()(k, 0),
                1e-8 * whole.sigma_rr.back().cwiseAbs().maxCoeff());
    EXPECT_NEAR(whole.sigma_tt.back()(k, 1), half.sigma_tt.back()(k, 1), 1e-5) << "friction +x";
  }
  EXPECT_NEAR(whole.bearing_area(0, 0), 0.3 * 0.1, 1e-12);
  EXPECT_NEAR(half.bearing_area(0, 0), 0.15 * 0.1, 1e-12);
}

/// Error of a rim's stresses over the largest, against a fine mesh, at p = 8: rows plain, program.
struct Errors {
  double plain_radial = 0, radial = 0, plain_hoop = 0, hoop = 0;
};
Errors errors(const std::string& space, int rings, std::size_t level) {
  const auto strip = [&](int n) {
    return test::solve(test::make_plate(
        test::grid_scene({0, 0.5, 2}, {0, 0.5}, {{"1", 0, 0, 0.25, n}},
                         R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
             "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])" +
                             space)));
  };
  const auto fine = strip(5), coarse = strip(rings);
  stage2::FieldSolver exact(fine, "fine"), solver(coarse, "coarse");
  exact.factorise(8);
  solver.factorise(fine.p[level]);
  const auto points = stage2::rim_points(coarse.mesh, solver.edges(), coarse.hole_rim[0]);
  const auto fine_points = stage2::rim_points(fine.mesh, exact.edges(), fine.hole_rim[0]);
  const auto n_cases = coarse.n_cases();
  const Eigen::VectorXd traction = Eigen::VectorXd::Unit(n_cases, n_cases - 1);
  const auto fields = solver.solve(traction);
  const auto sigma = stage2::RimStress(solver, 0, points)(fields);
  const auto exact_sigma = stage2::RimStress(exact, 0, fine_points)(exact.solve(traction));
  Errors e;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = [i](const stage2::RimStresses& s) { return Eigen::Vector3d(s.rr(0, i), s.tt(0, i), s.rt(0, i)); };
    const Eigen::Vector3d right = at(exact_sigma);
    const Eigen::Vector3d plain = (test::plain_rim_stress(fields, points[i]).rightCols<1>() - right).cwiseAbs();
    const Eigen::Vector3d ours = (at(sigma) - right).cwiseAbs();
    e = {std::max(e.plain_radial, plain[0]), std::max(e.radial, ours[0]), std::max(e.plain_hoop, plain[1]),
         std::max(e.hoop, ours[1])};
  }
  return e;
}

TEST_P(RimStress, RadialStressConvergesAsDisplacementsDo) {
  double worst = 0;
  for (std::size_t level = 3; level < 8; ++level) {
    const Errors e = errors(space(), 1, level);
    EXPECT_LT(e.radial, 0.35 * e.plain_radial) << "p=" << level + 1;
    EXPECT_LT(e.hoop, 2 * e.plain_hoop) << "p=" << level + 1;  // of the same order, and cheaper
    worst = e.hoop;
  }
  EXPECT_LT(worst, 1e-2);  // of a mean stress of 20
}

TEST_P(RimStress, DegreesAreTheTwoHighest) {
  EXPECT_EQ(test::extract(strap(space() + R"(, "p": [2, 5])")).matrices.stresses.p, Eigen::Vector2i(4, 5));
  EXPECT_EQ(test::extract(strap(space() + R"(, "p": [3, 3])")).matrices.stresses.p, Eigen::VectorXi::Constant(1, 3));
}

TEST_P(RimStress, LoadsOnlyLeavesThemOut) {
  const test::Plate plate = test::make_plate(strap(space()));
  const auto solution = test::solve(plate);
  const auto extraction = test::extract(solution, false);
  EXPECT_EQ(extraction.matrices.stresses.p.size(), 0);
  const auto& rims = extraction.matrices.stresses;
  EXPECT_EQ(rims.angle.size(), 0);
  EXPECT_EQ(rims.rim_radius, Eigen::Vector3d(0.125, 0.15, 0.2))
      << "a joint compares what its input says with the sheet";
  EXPECT_LT((rims.rim_thickness.array() - 0.1).abs().maxCoeff(), 1e-15);
  EXPECT_LT((rims.rim_modulus.array() / 1e7 - 1).abs().maxCoeff(), 1e-14);
  ASSERT_TRUE(extraction.checks.reciprocity);
  EXPECT_LT(*extraction.checks.reciprocity, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Spaces, RimStress, test::both_spaces(), test::space_tested);

}  // namespace
}  // namespace fastjoint
