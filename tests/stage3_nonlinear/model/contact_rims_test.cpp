// SPDX-License-Identifier: GPL-3.0-or-later
// What rims of contact add to a plate's matrices, of waves that elements carry and of shorter ones in closed form.
#include "stage3_nonlinear/model/contact_rims.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <random>

#include "common/pfem/material.hpp"
#include "common/rim/rim_compliance.hpp"
#include "stage3_nonlinear/interfaces/rim_problem.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"

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
formats::PlateMatrices infinite_sheet(int carried, const rim::ElasticDisk& disk = {}) {
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
  a.contact = {{"1", all, K, rim_radius, area, disk}};
  a.waves = {{"1", waves, rim_radius, area, K, laminate()}};
  formats::StressRows W(std::ssize(rows), 2 + std::ssize(rows));
  W << by_motion(rows, Eigen::all), by_load(rows, rows);
  a.W = {area * W};
  return a;
}

double difference(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// The matrices with what make_plate asks for besides: a stiffness of the disc, and nothing else.
PlateModel plate_of(formats::PlateMatrices a) {
  a.S_dd = {1e5 * MatrixXd::Identity(2, 2)};
  a.S_ed = {MatrixXd(0, 2)};
  a.S_ee = {MatrixXd(0, 0)};
  a.R_df = {MatrixXd(2, 0)};
  a.R_ef = {MatrixXd(0, 0)};
  a.T_d = {MatrixXd(2, 0)};
  a.T_e = {MatrixXd(0, 0)};
  a.C_t = {MatrixXd(0, 0)};
  a.disc_modulus = VectorXd::Constant(2, K);
  a.S_dd_error = MatrixXd::Zero(2, 2);
  return make_plate("sheet", "sheet.h5", std::move(a), 8);
}

/// A state of the disc in the infinite sheet: its displacement, the force on it, and what its rim does.
struct DiscState {
  VectorXd u, force, w, pressure;
};

/// The disc of a plate under contact coordinates c of the first waves.
DiscState state_of(const PlateModel& plate, double gap, double mu, const Eigen::Vector2d& u) {
  const Index k = plate.n_unknowns() - 2;
  constexpr double stiffness = 1e4;  // little, so that the springs between the rims are always the same
  const RimProblem rim(plate.contact_waves[0]->up_to(plate.contact[0].pressures.highest), area, stiffness, gap, mu);
  // The rim's force f and the plate's on the moments, S (u, m) + R tau, add up to nothing: Newton's method for c.
  VectorXd c = VectorXd::Zero(k);
  const MatrixXd S = plate.S.bottomRightCorner(k, k), R = plate.R.bottomRows(k);
  for (int i = 0; i < 50; ++i) {
    const RimSolution& its = rim.solve(c);
    const VectorXd f = its.forces.head(k), m = (c - f) / stiffness;
    const MatrixXd df = rim.contact().stiffness() * its.touching.gram.topRows(k) * its.w_by_c;
    VectorXd r = f + S * m + plate.S.bottomLeftCorner(k, 2) * u;
    MatrixXd J = df + S * (MatrixXd::Identity(k, k) - df) / stiffness;
    if (mu > 0) {
      r += R * its.friction.forces.head(R.cols()) / area;
      J += rim.modulus() * R * its.friction.slopes.topRows(R.cols()) * its.w_by_c;
    }
    const VectorXd step = J.lu().solve(r);
    c -= step;
    if (step.norm() < 1e-13 * c.norm()) break;
  }
  const RimSolution& its = rim.solve(c);
  const VectorXd m = (c - its.forces.head(k)) / stiffness;
  VectorXd force = plate.S.topLeftCorner(2, 2) * u + plate.S.topRightCorner(2, k) * m;
  if (mu > 0) force += plate.R.topRows(2) * its.friction.forces.head(R.cols()) / area;
  const VectorXd w = rim.against_sheet(its.w, its.forces / area, its.friction.forces / area);
  return {u, force, w, its.forces / area};
}

/// In an infinite sheet the closed form is all there is: however few waves are carried below the upper third, the rim
/// does the same, with gap and interference, with friction and without.
TEST(ContactRims, OfAnInfiniteSheetDoNotDependOnWhatIsCarried) {
  const Eigen::Vector2d u(0.03, 0.02);
  for (const double gap : {0.0, 0.01, -0.02})
    for (const auto& [mu, disk] :
         {std::pair(0.0, rim::ElasticDisk{}), {0.3, {}}, {0.0, {50e3, 0.3}}, {0.3, {50e3, 0.3}}}) {
      const DiscState all = state_of(plate_of(infinite_sheet(6, disk)), gap, mu, u);
      for (const int carried : {3, 4, 5}) {
        const DiscState some = state_of(plate_of(infinite_sheet(carried, disk)), gap, mu, u);
        EXPECT_LT(difference(some.force, all.force), 1e-11) << carried << ", gap " << gap << ", friction " << mu;
        EXPECT_LT(difference(some.w, all.w), 1e-11) << carried << ", gap " << gap << ", friction " << mu;
        EXPECT_LT(difference(some.pressure, all.pressure), 1e-11) << carried << ", gap " << gap;
      }
    }
}

TEST(ContactRims, KeepWhatTheFileHasWhereNoClosedFormHolds) {
  auto a = infinite_sheet(4);
  a.waves[0].compliance.setZero();
  a.contact[0].pressures.highest = 4;
  const RimMatrices found = rim_matrices(a, 0);
  EXPECT_LT(difference(found.C, -a.W[0].block(0, 2, 9, 9) / (area * area)), 1e-15);
  EXPECT_LT(difference(found.B, a.W[0].block(0, 0, 9, 2) / area), 1e-15);
  EXPECT_TRUE(ContactWaves(a.contact[0], a.waves[0]).fewest().is_empty());
}

/// What the joint needs of it to be convex: the springs' compliance is more than the sheet's with them, and what the
/// joint sees of a sheet without springs and short waves has no negative eigenvalue.
TEST(ContactRims, OfASheetAreLessCompliantThanItsSprings) {
  for (const int carried : {3, 4, 8}) {
    const MatrixXd C = area * rim_matrices(infinite_sheet(carried), 0).C;
    EXPECT_LT(difference(C, C.transpose()), 1e-13);
    const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(C).eigenvalues();
    EXPECT_GT(values.minCoeff(), 0) << carried;
    EXPECT_LT(values.maxCoeff(), 1 / K) << carried;
    const MatrixXd S = plate_of(infinite_sheet(carried)).S;
    const Index k = S.rows() - 2;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(S.bottomRightCorner(k, k)).eigenvalues()[0], 0) << carried;
  }
}

/// A rim of an infinite isotropic sheet that leaves the number of its waves to the joint.
ContactWaves rim_of(double spring, const rim::ElasticDisk& disk) {
  const Eigen::Matrix3d sheet = pfem::elasticity(pfem::isotropic(70e3, 0.3), 0, pfem::Analysis::plane_stress).inverse();
  return {{"1", rim::Harmonics{0}, spring, rim_radius, area, disk},
          {"1", rim::Harmonics{4}, rim_radius, area, spring, sheet}};
}

/// What waves beyond N have in common is such that the ends of contact come as N^-2, with springs of any stiffness
/// and with elastic disks, and so do the waves of the pressure.
TEST(ContactWaves, OfAnOrderLeaveAnErrorOfItsInverseSquare) {
  std::mt19937 random(7);
  double coarse = 0, fine = 0, worst = 0;
  for (int i = 0; i < 40; ++i) {
    const rim::ElasticDisk disk = i % 2 == 0 ? rim::ElasticDisk{} : rim::ElasticDisk{decades(random, 2e4, 2e6), 0.3};
    const ContactWaves waves = rim_of(decades(random, 1e3, 1e6), disk);
    const double gap = i % 4 < 2 ? 0 : decades(random, 1e-4, 1e-2), k = 1e6;
    const auto half_arc = [&](int order) {
      const RimProblem rim(waves.up_to(order), area, k, gap, 0);
      VectorXd c = VectorXd::Zero(9);
      c.head(2) << 0.1 * k * gap, 0.01 * k;
      const auto& arcs = rim.solve(c).touching.arcs;
      double touching = 0;
      for (const auto& arc : arcs) touching += arc.to - arc.from;
      return touching / 2;
    };
    const double exact = half_arc(200), at_24 = std::abs(half_arc(24) - exact);
    coarse += at_24, fine += std::abs(half_arc(48) - exact);
    worst = std::max(worst, at_24);
  }
  EXPECT_LT(worst, 2e-4);
  EXPECT_LT(fine, coarse / 3.5);
}

TEST(ContactWaves, OfOrderOneAloneHaveACompliance) {
  for (const double sweep : {rim::full_turn, rim::full_turn / 2, rim::full_turn / 4})
    for (const int highest_order : {1, 2, 3}) {
      const rim::Harmonics all{highest_order, 0, sweep}, one{1, 0, sweep};
      const ContactWaves waves({"1", all, 1e4, rim_radius, area, {70e3, 0.3}},
                               {"1", one, rim_radius, area, 1e4, laminate()});
      const RimProblem rim(waves.up_to(highest_order), area, 1e6, 0, 0);
      VectorXd c = VectorXd::Zero(one.size());
      c[0] = 100;
      EXPECT_TRUE(rim.solve(c).forces.allFinite() && rim.solve(c).forces[0] > 0) << highest_order << " " << sweep;
    }
}

TEST(ContactWaves, AreMoreTheNarrowerTheArc) {
  const ContactWaves waves = rim_of(1e4, {70e3, 0.3});
  const double force = 1000;
  EXPECT_EQ(waves.order(0, force), 20);
  EXPECT_EQ(waves.order(-0.01, force), 20);
  EXPECT_EQ(waves.order_to_compare(20, 0), 10);
  EXPECT_EQ(waves.order_to_compare(20, 0.2), 40) << "friction on a disk";
  EXPECT_EQ(waves.order_to_compare(128, 0.2), 64) << "more are not to be had";
  int before = 0;
  for (double gap = 1e-4; gap < 100; gap *= 1.5) {
    const int order = waves.order(gap, force);
    EXPECT_EQ(order % 4, 0);
    EXPECT_GE(order, before);
    EXPECT_EQ(order, waves.order(2 * gap, 2 * force)) << "of loads and gaps twice as large";
    before = order;
  }
  EXPECT_EQ(before, 128);
  const ContactWaves fixed({"1", rim::Harmonics{9}, 1e4, rim_radius, area},
                           {"1", rim::Harmonics{4}, rim_radius, area, 1e4});
  EXPECT_EQ(fixed.order(10, force), 9);
  EXPECT_EQ(fixed.order_to_compare(9, 0.2), 4) << "the file says how many";
}

}  // namespace contact_rims_test
}  // namespace fastjoint::stage3
