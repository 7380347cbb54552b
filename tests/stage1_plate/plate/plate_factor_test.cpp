// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_factor.hpp"

#include <gtest/gtest.h>

#include "common/linalg/threads.hpp"
#include "tests/support/plate_scenes.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

/// S and R by shortcuts (elements and cells condensed, each congruence class once, no solve) against the
/// straightforward path.
TEST(PlateFactor, GivesWhatTheStraightforwardPathGives) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, problem);
    const plate::Skeleton skeleton(problem);
    for (int p = 1; p <= 8; ++p) {
      const auto plain = test::plain_matrices(K_ff, problem, p);
      const Eigen::MatrixXd E = plate::PlateFactor(problem, skeleton, p, border_diagonal(problem)).energy_rows();
      const auto nc = problem.K_cc.rows();
      const Eigen::MatrixXd S = E.topRows(nc) * E.topRows(nc).transpose();
      const Eigen::MatrixXd R = E.topRows(nc) * E.bottomRows(E.rows() - nc).transpose();
      EXPECT_LT((S - Eigen::MatrixXd(shift(problem).asDiagonal()) - plain.S).norm(), 1e-11 * problem.K_cc.norm())
          << name << ", p = " << p;
      EXPECT_LE((R - plain.R).norm(), 1e-11 * plain.R.norm()) << name << ", p = " << p;
    }
  }
}

TEST(PlateFactor, IsTheSameOnSeveralThreads) {
  const auto plate = test::make_plate(test::panel(3, 2, 1));
  const plate::Skeleton skeleton(plate.problem);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(plate.problem.K_fc.rows(), 3);
  const plate::PlateFactor one(plate.problem, skeleton, 8, border_diagonal(plate.problem));
  const Eigen::MatrixXd E = one.energy_rows(), X = one.solve(B);
  linalg::set_threads(3);
  const plate::PlateFactor three(plate.problem, skeleton, 8, border_diagonal(plate.problem));
  EXPECT_LT((three.energy_rows() - E).norm(), 1e-13 * E.norm());
  EXPECT_LT((three.solve(B) - X).norm(), 1e-12 * X.norm());
  linalg::set_threads(1);
}

TEST(PlateFactor, SolvesForAnyLoads) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
    const plate::Skeleton skeleton(plate.problem);
    for (const int p : {1, 2, 5, 8}) {
      const int n = plate.problem.unknowns.n_free[p];
      const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, 70);  // more than one block of columns
      const Eigen::MatrixXd X = plate::PlateFactor(plate.problem, skeleton, p).solve(B);
      const Eigen::MatrixXd residual = K_ff.topLeftCorner(n, n) * X - B;
      EXPECT_LT(residual.norm(), 1e-12 * K_ff.norm() * X.norm()) << name << ", p = " << p;
    }
  }
}

}  // namespace
}  // namespace fastjoint
