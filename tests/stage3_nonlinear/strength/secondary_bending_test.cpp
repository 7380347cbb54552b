// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "stage3_nonlinear/strength/beam_column.hpp"
#include "stage3_nonlinear/strength/hole_bending.hpp"
#include "stage3_nonlinear/strength/sheet_stack.hpp"

namespace fastjoint::stage3::secondary_bending_test {

using Eigen::Matrix4d;

/// Stiffness of a beam by n equal cubic elements with their geometric stiffness, condensed onto its ends.
Matrix4d by_cubic_elements(const BeamColumn& beam, int n) {
  const double L = beam.length / n, EI = beam.EI, N = beam.N;
  Matrix4d K, G;
  K << 12, 6 * L, -12, 6 * L, 6 * L, 4 * L * L, -6 * L, 2 * L * L, -12, -6 * L, 12, -6 * L, 6 * L, 2 * L * L, -6 * L,
      4 * L * L;
  G << 36, 3 * L, -36, 3 * L, 3 * L, 4 * L * L, -3 * L, -L * L, -36, -3 * L, 36, -3 * L, 3 * L, -L * L, -3 * L,
      4 * L * L;
  const Matrix4d element = EI / (L * L * L) * K + N / (30 * L) * G;
  MatrixXd all = MatrixXd::Zero(2 * n + 2, 2 * n + 2);
  for (int i = 0; i < n; ++i) all.block<4, 4>(2 * i, 2 * i) += element;
  std::vector<int> ends{0, 1, 2 * n, 2 * n + 1}, inner;
  for (int i = 2; i < 2 * n; ++i) inner.push_back(i);
  if (inner.empty()) return all(ends, ends);
  return all(ends, ends) - all(ends, inner) * all(inner, inner).lu().solve(all(inner, ends));
}

TEST(BeamColumn, CubicElementsConvergeToItByTheFourthOrder) {
  for (const double N : {9.0, 0.02, 0.005, -0.005, -0.02, -9.0, 400.0}) {
    const BeamColumn beam{1, N, 1};
    const auto error = [&](int n) { return (by_cubic_elements(beam, n) - beam.stiffness()).norm(); };
    EXPECT_LT(error(128), 1e-7 * beam.stiffness().norm()) << N;
    if (std::abs(N) > 1) {
      EXPECT_NEAR(std::log2(error(32) / error(64)), 4, 0.1) << N;
    }
  }
}

TEST(BeamColumn, MovesFreelyAndTurnsAgainstItsTension) {
  for (const double N : {1e5, 40.0, 0.0, -3.0}) {
    const BeamColumn beam{2, N, 3};
    const Matrix4d K = beam.stiffness();
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    EXPECT_LT((K * Eigen::Vector4d(1, 0, 1, 0)).norm(), 1e-12 * K.norm());
    // Turned by theta, the ends of a bar under tension are pulled back by N theta.
    EXPECT_LT((K * Eigen::Vector4d(0, 1, 3, 1) - N * Eigen::Vector4d(-1, 0, 1, 0)).norm(), 1e-10 * K.norm());
  }
}

TEST(BeamColumn, ShorteningIsTheDerivativeByTension) {
  for (const double N : {500.0, 2.0, 0.004, 0.0, -0.004, -2.0, -5.0}) {
    const double h = 1e-3 * std::max(std::abs(N), 1.0);
    const Matrix4d difference = (BeamColumn{1, N + h, 1}.stiffness() - BeamColumn{1, N - h, 1}.stiffness()) / (2 * h);
    EXPECT_LT((BeamColumn{1, N, 1}.by_tension() - difference).norm(), 1e-6 * difference.norm()) << N;
  }
}

/// A lap of n rows 20 mm apart: sheets 2 mm thick and 20 mm wide of 72000 N/mm^2 with nu = 0, hinged 100 mm from it.
struct Lap {
  SheetStack stack;
  StackLoads loads;

  /// @param shares Of the load P that each row transfers.
  Lap(const std::vector<double>& shares, double P) {
    const Index n = std::ssize(shares);
    loads.q = P * VectorXd::Map(shares.data(), n);
    for (const bool is_lower : {true, false}) {
      StackSheet sheet;
      sheet.at.resize(n + 2);
      sheet.at << (is_lower ? -100 : -8), VectorXd::LinSpaced(n, 0, 20.0 * double(n - 1)),
          20.0 * double(n - 1) + (is_lower ? 8 : 100);
      sheet.EI = VectorXd::Constant(n + 1, 72000 * 20 * 8 / 12.0);
      sheet.width = VectorXd::Constant(n + 1, 20), sheet.thickness = VectorXd::Constant(n + 1, 2);
      sheet.ends = {is_lower ? EndHold::hinged : EndHold::free, is_lower ? EndHold::free : EndHold::hinged};
      VectorXd N = VectorXd::Constant(n + 1, is_lower ? P : 0);
      for (Index row = 0; row < n; ++row) {
        sheet.rows.push_back(row + 1);
        N.tail(n - row).array() += (is_lower ? -1 : 1) * loads.q[row];
        if (is_lower) stack.links.push_back({0, row, 1, row});
      }
      loads.N.push_back((N.array().abs() > 1e-9 * P).select(N, 0));
      stack.sheets.push_back(sheet);
    }
  }
};

TEST(SheetStack, SingleLapsBendAsIndependentBeamsSay) {
  struct Row {
    std::vector<double> shares;
    double stress;
    bool clamped;
    double k_b, w;
  };
  const std::vector<Row> table{{{1}, 100, false, 3, 0},
                               {{.5, .5}, 100, false, 1.6792, .3494},
                               {{.5, .5}, 100, true, 1.8702, .2857},
                               {{.3577, .2846, .3577}, 100, false, 1.2547, .4151},
                               {{.3605, .2790, .3605}, 100, true, 1.3560, .3813},
                               {{.3524, .2952, .3524}, 200, false, 1.0369, .4877},
                               {{.3557, .2886, .3557}, 200, true, 1.1632, .4456},
                               {{.2932, .2068, .2068, .2932}, 100, false, .9782, .4432},
                               {{.2980, .2020, .2020, .2980}, 100, true, 1.0829, .4083},
                               {{.3893, .2214, .3893}, 1, false, 2.4398, .0201}};
  for (const auto& [shares, stress, clamped, k_b, w] : table) {
    const Lap lap(shares, 40 * stress);
    const StackShape shape = lap.stack.bend(lap.loads, clamped);
    EXPECT_NEAR(6 * std::abs(shape.moment[0](1, 0)) / 80 / stress, k_b, 2e-4 * k_b);
    EXPECT_NEAR(std::abs(shape.w[0][1]), w, 2e-4);
    EXPECT_NEAR(shape.moment[0](1, 0), -shape.moment[1](std::ssize(shares), 1), 1e-9 * 40 * stress);
  }
}

/// Straps on both sides of a sheet, with forces that are not those of any joint.
TEST(SheetStack, SymmetricDoubleShearDoesNotBendWhateverTheHeads) {
  Lap lap({.4, .25, .35}, 4000);
  lap.stack.sheets.push_back(lap.stack.sheets[0]);
  lap.loads.N.push_back(lap.loads.N[0]);
  std::swap(lap.stack.sheets[1], lap.stack.sheets[2]);  // strap, strap, sheet
  lap.loads.N[2] = 2 * lap.loads.N[1], std::swap(lap.loads.N[1], lap.loads.N[0]);
  lap.loads.N[1] = lap.loads.N[0];
  lap.stack.links.clear();
  for (Index row = 0; row < 3; ++row) lap.stack.links.push_back({0, row, 2, row});
  for (Index row = 0; row < 3; ++row) lap.stack.links.push_back({2, row, 1, row});
  const VectorXd q = lap.loads.q;
  lap.loads.q.resize(6);
  lap.loads.q << q, -q;
  for (const bool clamped : {false, true}) {
    const StackShape shape = lap.stack.bend(lap.loads, clamped);
    for (const auto& w : shape.w) EXPECT_LT(w.lpNorm<Eigen::Infinity>(), 1e-12);
    for (const auto& moment : shape.moment) EXPECT_LT(moment.lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_EQ(shape.pressed, std::vector<bool>(6, !clamped));
  }
}

TEST(SheetStack, CompressionBeyondEulersLoadIsToldAsBuckling) {
  const double load = std::numbers::pi * std::numbers::pi * 72000 * 20 * 8 / 12 / (100 * 100);
  for (const double share : {0.5, 0.99, 1.5, 5.0, 20.0, 40.0, 100.0}) {  // a bar of one sheet, hinged at both ends
    SheetStack stack;
    StackSheet bar;
    bar.at = Eigen::Vector3d(0, 40, 100);
    bar.EI = Eigen::Vector2d::Constant(72000 * 20 * 8 / 12.0);
    bar.width = Eigen::Vector2d::Constant(20), bar.thickness = Eigen::Vector2d::Constant(2);
    bar.ends = {EndHold::hinged, EndHold::hinged};
    bar.rows = {1};
    stack.sheets.push_back(bar);
    const StackShape shape = stack.bend({{Eigen::Vector2d::Constant(-share * load)}, VectorXd(0)}, false);
    EXPECT_EQ(shape.buckles, share > 1);
    EXPECT_EQ(std::isnan(shape.moment[0](1, 0)), share > 1);
  }
}

TEST(HoleBending, ConcentrationIsReissnersFromThickToThinSheets) {
  const std::array<std::array<double, 3>, 6> table{{{.25, 2.51989, 2.41779},
                                                    {.5, 2.26067, 2.13482},
                                                    {1, 2.05753, 1.92654},
                                                    {2, 1.93119, 1.80253},
                                                    {5, 1.84712, 1.72222},
                                                    {1e6, 1.78788, 5.0 / 3}}};
  for (const auto& [ratio, poisson, none] : table) {
    EXPECT_NEAR(bending_concentration(ratio, 0.3), poisson, 2e-5 * poisson) << ratio;
    EXPECT_NEAR(bending_concentration(ratio, 0), none, 2e-5 * none) << ratio;
  }
}

TEST(HoleBending, PeakIsThatOfTheSumAndTurnsWithTheLoad) {
  const Index n = 1024;
  const auto field = [&](double turned) {
    return VectorXd(VectorXd::NullaryExpr(n, [&](Index i) {
      return 100 - 200 * std::cos(2 * (2 * std::numbers::pi * (double(i) + 0.5) / double(n) - turned));
    }));
  };
  // In the plane a plate in tension of 100, and bending of 50 on its worse side.
  const auto along_x = peak_with_bending(field(0), {{{50, 20}, {0, 0}}}, 2.2, 0);
  EXPECT_NEAR(along_x.value, 300 + 50 * 2.2, 1e-2);
  EXPECT_NEAR(std::abs(along_x.angle), 90, 0.2);
  const auto along_y = peak_with_bending(field(std::numbers::pi / 2), {{{0, 0}, {20, 50}}}, 2.2, 0);
  EXPECT_NEAR(along_y.value, along_x.value, 1e-9);
  EXPECT_NEAR(std::abs(std::remainder(along_y.angle, 180)), 0, 0.2);
  // Bent cylindrically without anything in the plane: K_b + nu (2 - K_b) beside the hole.
  EXPECT_NEAR(peak_with_bending(VectorXd::Zero(n), {{{50, 50}, {0, 0}}}, 2.2, 0.3).value, 50 * (2.2 + 0.3 * (2 - 2.2)),
              1e-3);
  EXPECT_TRUE(std::isnan(peak_with_bending({}, {{{50, 20}, {0, 0}}}, 2.2, 0).value));
}

}  // namespace fastjoint::stage3::secondary_bending_test
