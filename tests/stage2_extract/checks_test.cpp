// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/checks.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <functional>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::HasSubstr;

const std::string floating = test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                              R"(, "disc_directions": ["x", "y"],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])");

/// A sheet that only its fasteners and a boundary hold: every check applies, S has exactly the three rigid motions.
TEST(Checks, FloatingSheet) {
  const auto result = test::extract(floating);
  EXPECT_LT(*result.checks.energy, 1e-12);
  EXPECT_FALSE(result.checks.negative_eigenvalue);
  ASSERT_TRUE(result.checks.reciprocity && result.checks.equilibrium);
  EXPECT_LT(*result.checks.reciprocity, 1e-12);
  EXPECT_LT(*result.checks.equilibrium, 1e-12);
  EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
}

TEST(Checks, RigidMotionsAreTheNullSpaceOfS) {
  const auto m = test::extract(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                                R"(, "disc_directions": ["x", "y"])"))
                     .matrices;
  const Eigen::MatrixXd& S = m.S_dd.back();  // a.x a.y b.x b.y
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues();
  EXPECT_LT(values.head(2).cwiseAbs().maxCoeff(), 1e-12 * values[3]);  // translations: exact
  const Eigen::Vector4d turning(-0.5, 0.4, -0.6, 1.5);
  EXPECT_LT((S * turning).norm(),
            1e-6 * S.norm());  // turning: as exact as the arcs' maps allow, see element_stiffness_test
  EXPECT_GT(values[3], 0.1 * S.norm());
}

TEST(Checks, SupportedSheetHasNothingToCheckOfEquilibrium) {
  EXPECT_FALSE(test::extract(test::panel(1, 1)).checks.equilibrium);
}

/// The checks can fail: each of them on a solution that is spoilt in the digit that it looks at.
TEST(Checks, SpoiltSolutionsAreFound) {
  const auto good = test::solve(test::make_plate(floating));
  const auto complaint_of = [&](const std::function<void(formats::PlateSolution&)>& spoil) -> std::string {
    auto spoilt = good;
    spoil(spoilt);
    try {
      stage2::require_good(stage2::extract(spoilt, "plate.h5", "test").checks, "f.h5");
    } catch (const NumericalError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_THAT(complaint_of([](auto& a) { a.probe.u *= 1 + 1e-6; }), HasSubstr("f.h5: error of S is"));
  EXPECT_THAT(
      complaint_of([](auto& a) { a.cases.back().E_h(2, 0) += 1e-6 * a.cases.back().E_h.cwiseAbs().maxCoeff(); }),
      HasSubstr("error of reciprocity"));
  EXPECT_THAT(complaint_of([](auto& a) { a.probe.w *= 1 + 1e-6; }), HasSubstr("error of reciprocity"));
  EXPECT_THAT(complaint_of([](auto& a) {
                a.shift *= 0.999;
                a.K_cc.diagonal() += a.shift / 0.999 * 1e-3;
              }),
              HasSubstr("error of global equilibrium"));
  EXPECT_THAT(complaint_of([](auto& a) { a.shift *= 1.5; }), HasSubstr("smallest eigenvalue of S"));
}

}  // namespace
}  // namespace fastjoint
