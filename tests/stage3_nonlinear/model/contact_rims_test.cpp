// SPDX-License-Identifier: GPL-3.0-or-later
// What rims of contact add to a plate's matrices, of waves that elements carry and of shorter ones in closed form.
#include "stage3_nonlinear/model/contact_rims.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "common/pfem/material.hpp"
#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {
namespace contact_rims_test {

constexpr int highest = 9;
constexpr double rim_radius = 2, area = 3, K = 4e3;

/// A laminate off its axes, in which every wave of pressure moves the rim in others and along it.
Eigen::Matrix3d laminate() {
  return pfem::elasticity({140e3, 10e3, 10e3, 0.3, 0.3, 0.4, 5e3}, 0.4, pfem::Analysis::plane_stress).inverse();
}

/// An infinite sheet with one rim of contact and a disc that moves along x and y, its waves carried up to an order.
/// The displacements of order 0 and 1, which the closed form leaves out, are made up.
formats::PlateMatrices infinite_sheet(int carried) {
  const rim::Harmonics all{highest}, waves{carried};
  const Index n = all.size();
  MatrixXd D = rim::RimCompliance(laminate(), rim_radius).displacements(all);
  for (const Index k : {Index(0), Index(1), Index(2), n, n + 1, n + 2}) D(k, k) = D(4, 4);
  const MatrixXd D_nn = D.topLeftCorner(n, n), D_nt = D.topRightCorner(n, n), D_tt = D.bottomRightCorner(n, n);
  MatrixXd b(n, 2), b_t(n, 2);
  for (const int axis : {0, 1}) b.col(axis) = all.push(axis), b_t.col(axis) = all.drag(axis);
  // Springs that push and pull make p = K w + q, and w = b u - D_nn p - D_nt tau, v = b_t u - D_tn p - D_tt tau.
  const MatrixXd held = (MatrixXd::Identity(n, n) + K * D_nn).inverse();
  MatrixXd by_motion(2 * n, 2), by_load(2 * n, 2 * n);
  by_motion << held * b, b_t - K * D_nt.transpose() * held * b;
  by_load << -held * D_nn, -held * D_nt, -D_nt.transpose() * (MatrixXd::Identity(n, n) - K * held * D_nn),
      -D_tt + K * D_nt.transpose() * held * D_nt;
  std::vector<Index> rows;
  for (Index k = 0; k < waves.size(); ++k) rows.push_back(k);
  for (Index k = 0; k < waves.n_shears(); ++k) rows.push_back(n + k);
  formats::PlateMatrices a;
  a.p = Eigen::VectorXi::Constant(1, 8);
  a.disc_hole = {"1", "1"};
  a.disc_direction = {"x", "y"};
  a.contact = {{"1", all, K, rim_radius, area}};
  a.waves = {{"1", waves, rim_radius, area, K, laminate()}};
  formats::StressRows W(std::ssize(rows), 2 + std::ssize(rows));
  W << by_motion(rows, Eigen::all), by_load(rows, rows);
  a.W = {area * W};
  return a;
}

double difference(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// In an infinite sheet the closed form is all there is: however few waves are carried, the joint sees the same rim.
TEST(ContactRims, OfAnInfiniteSheetDoNotDependOnWhatIsCarried) {
  const RimMatrices all = rim_matrices(infinite_sheet(highest), 0);
  ASSERT_EQ(all.C.rows(), 2 * highest + 1);
  for (const int carried : {3, 4, 5, 8}) {
    const RimMatrices some = rim_matrices(infinite_sheet(carried), 0);
    EXPECT_LT(difference(some.B, all.B), 1e-13) << carried;
    EXPECT_LT(difference(some.C, all.C), 1e-13) << carried;
    EXPECT_LT(difference(some.R, all.R), 1e-13) << carried;
    EXPECT_LT(difference(some.R_p, all.R_p), 1e-13) << carried;
  }
}

TEST(ContactRims, KeepWhatTheFileHasWhereNoClosedFormHolds) {
  auto a = infinite_sheet(4);
  a.waves[0].compliance.setZero();
  a.contact[0].pressures.highest = 4;
  const RimMatrices found = rim_matrices(a, 0);
  EXPECT_LT(difference(found.C, -a.W[0].block(0, 2, 9, 9) / (area * area)), 1e-15);
  EXPECT_LT(difference(found.B, a.W[0].block(0, 0, 9, 2) / area), 1e-15);
  EXPECT_TRUE(short_waves(a.contact[0], a.waves[0]).is_empty());
}

/// What the joint needs of them to be convex: the springs' compliance is more than the sheet's with them.
TEST(ContactRims, OfASheetAreLessCompliantThanItsSprings) {
  for (const int carried : {3, 4, 8}) {
    const MatrixXd C = area * rim_matrices(infinite_sheet(carried), 0).C;
    EXPECT_LT(difference(C, C.transpose()), 1e-13);
    const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(C).eigenvalues();
    EXPECT_GT(values.minCoeff(), 0) << carried;
    EXPECT_LT(values.maxCoeff(), 1 / K) << carried;
  }
}

}  // namespace contact_rims_test
}  // namespace fastjoint::stage3
