// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_factor.hpp"

#include <gtest/gtest.h>

#include "common/linalg/processor.hpp"
#include "tests/support/plate_scenes.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

/// Rows of the border that mean something: all but those of friction cases.
std::vector<int> rows_of_forces_and_waves(const plate::Unknowns& unknowns) {
  std::vector<int> rows;
  const int first = unknowns.n_controlled() + unknowns.n_loaded;
  for (int i = 0; i < unknowns.n_border(); ++i)
    if (i < first || i >= first + unknowns.n_friction) rows.push_back(i);
  return rows;
}

/// S, R and W by shortcuts (elements condensed, each class once, no solution) against the straightforward path.
TEST(PlateFactor, GivesWhatTheStraightforwardPathGives) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, problem);
    const plate::Skeleton skeleton(problem);
    for (int p = 1; p <= 8; ++p) {
      const auto plain = test::plain_matrices(K_ff, problem, p);
      const plate::PlateFactor K(problem, skeleton, p, true);
      const auto nc = problem.K_cc.rows();
      const Eigen::MatrixXd all = K.condensed();
      const auto rows = rows_of_forces_and_waves(problem.unknowns);
      ASSERT_EQ(all.rows(), plain.rows());
      ASSERT_EQ(all.cols(), plain.cols());
      const Eigen::MatrixXd error = (all - plain)(rows, Eigen::all), right = plain(rows, Eigen::all);
      const auto n_loads = right.cols() - nc, n_waves = right.rows() - nc;
      EXPECT_LT(error.topLeftCorner(nc, nc).norm(), 1e-11 * problem.K_cc.norm()) << name << ", p = " << p;
      const auto check = [&](const auto& part, const Eigen::MatrixXd& of_error, const Eigen::MatrixXd& of_right) {
        EXPECT_LE(of_error.norm(), 1e-11 * of_right.norm()) << part << " of " << name << ", p = " << p;
      };
      check("forces by loads", error.topRightCorner(nc, n_loads), right.topRightCorner(nc, n_loads));
      check("waves by motion", error.bottomLeftCorner(n_waves, nc), right.bottomLeftCorner(n_waves, nc));
      check("waves by loads", error.bottomRightCorner(n_waves, n_loads), right.bottomRightCorner(n_waves, n_loads));
      EXPECT_LT((K.diagonal_of_K_cc() - problem.K_cc.diagonal()).norm(), 1e-12 * problem.K_cc.norm()) << name;
    }
  }
}

TEST(PlateFactor, WithoutOtherWavesLacksTheirRowsAlone) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const plate::Skeleton skeleton(plate.problem);
    const Eigen::MatrixXd all = plate::PlateFactor(plate.problem, skeleton, 5, true).condensed();
    const Eigen::MatrixXd some = plate::PlateFactor(plate.problem, skeleton, 5, false).condensed();
    ASSERT_EQ(some.rows(), plate.problem.unknowns.n_prescribed()) << name;
    EXPECT_LE((some - all.topRows(some.rows())).norm(), 1e-13 * all.norm()) << name;
  }
}

TEST(PlateFactor, IsTheSameOnSeveralThreads) {
  const auto plate = test::make_plate(test::panel(3, 2, 1));
  const plate::Skeleton skeleton(plate.problem);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(plate.problem.K_fc.rows(), 3);
  const auto solve = [&] {
    return std::pair(plate::PlateFactor(plate.problem, skeleton, 8, true).condensed(),
                     test::fields_under(plate.problem, 8, B));
  };
  const auto [SR, X] = solve();
  linalg::set_threads(3);
  const auto [by_three, X_by_three] = solve();
  linalg::set_threads(1);
  EXPECT_LT((by_three - SR).norm(), 1e-13 * SR.norm());
  EXPECT_LT((X_by_three - X).norm(), 1e-12 * X.norm());
}

TEST(PlateFactor, DegreesSideBySideAreThoseOneAfterAnother) {
  const auto plate = test::make_plate(test::panel(3, 1, 1));
  const auto plain = test::solve(plate);
  linalg::set_threads(3);
  const auto side_by_side = test::solve(plate);
  linalg::set_threads(1);
  ASSERT_EQ(side_by_side.cases.size(), plain.cases.size());
  for (std::size_t i = 0; i < plain.cases.size(); ++i) {
    EXPECT_EQ(side_by_side.cases[i].S, plain.cases[i].S) << i;
    EXPECT_EQ(side_by_side.cases[i].R, plain.cases[i].R) << i;
    EXPECT_EQ(side_by_side.cases[i].W, plain.cases[i].W) << i;
    EXPECT_EQ(side_by_side.cases[i].N, plain.cases[i].N) << i;
  }
  EXPECT_EQ(side_by_side.probe.force, plain.probe.force);
  EXPECT_EQ(side_by_side.held_stiffness, plain.held_stiffness);
}

TEST(PlateFactor, SolvesForAnyLoads) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
    for (const int p : {1, 2, 5, 8}) {
      const int n = plate.problem.unknowns.n_free[p];
      const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, 70);
      const Eigen::MatrixXd X = test::fields_under(plate.problem, p, B);
      const Eigen::MatrixXd residual = K_ff.topLeftCorner(n, n) * X - B;
      EXPECT_LT(residual.norm(), 1e-12 * K_ff.norm() * X.norm()) << name << ", p = " << p;
    }
  }
}

}  // namespace
}  // namespace fastjoint
