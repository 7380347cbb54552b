// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

TEST(ErrorEstimate, IsExactForAnAlgebraicSequence) {
  const Eigen::Vector3i N(100, 180, 300);
  for (const double rate : {0.5, 1.0, 3.0}) {
    const Eigen::VectorXd values = 7 + 5 * N.cast<double>().array().pow(-rate);
    EXPECT_NEAR(stage2::extrapolated_error(values, N) / (values[2] - 7), 1, 1e-6) << rate;
  }
}

TEST(ErrorEstimate, FallsBackToTheLastDifference) {
  EXPECT_DOUBLE_EQ(stage2::extrapolated_error(Eigen::Vector2d(3, 2.5), Eigen::Vector2i(10, 20)), 0.5);
  EXPECT_DOUBLE_EQ(stage2::extrapolated_error(Eigen::Vector3d(3, 2.9, 2.5), Eigen::Vector3i(10, 20, 30)), 0.4);
  EXPECT_TRUE(std::isinf(stage2::extrapolated_error(Eigen::VectorXd::Ones(1), Eigen::VectorXi::Ones(1))));
}

/// Against the true error, known from two finer rings of elements: honest to a factor, on the safe side.
TEST(ErrorEstimate, BoundsTheTrueErrorOfPanels) {
  for (const auto& [space, nx] : {std::pair{pfem::Space::trunk, 1},
                                  {pfem::Space::trunk, 2},
                                  {pfem::Space::trunk, 3},
                                  {pfem::Space::product, 1},
                                  {pfem::Space::product, 3}}) {
    const auto coarse = test::extract(test::panel(nx, 1, 0, test::in_space(space))).matrices;
    const auto fine = test::extract(test::panel(nx, 1, 2, test::in_space(space))).matrices;
    const auto check = [&](const Eigen::MatrixXd& S, const Eigen::MatrixXd& reference, const Eigen::MatrixXd& error) {
      for (Eigen::Index i = 0; i < S.rows(); ++i) {
        const double ratio = std::abs(S(i, i) - reference(i, i)) / error(i, i);
        EXPECT_GT(ratio, 0.3) << pfem::name_of(space) << " " << nx << " " << i;
        EXPECT_LT(ratio, 1.5) << pfem::name_of(space) << " " << nx << " " << i;
      }
      EXPECT_LT((S - reference).cwiseAbs().cwiseQuotient(error).maxCoeff(), 1.5);  // off the diagonal: a bound
    };
    check(coarse.S_ee.back(), fine.S_ee.back(), coarse.S_ee_error);
    check(coarse.S_dd.back(), fine.S_dd.back(), coarse.S_dd_error);
  }
}

}  // namespace
}  // namespace fastjoint
