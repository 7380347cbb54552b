// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/rim_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

constexpr double degree = std::numbers::pi / 180;

struct Plate {
  std::vector<std::string> holes;
  std::vector<int> axes;
  formats::PlateStresses stresses;
  int level;
};

/// A plate with the disc "1" and two cases; the hoop stress of the first case is `hoop` at the higher degree and 1 %
/// more below; sections carry 3 (right) and 5 (left) times the second case.
Plate plate(double from, double to, const std::function<double(double)>& hoop) {
  Plate model{{"1"}, {0}, {}, 1};
  formats::PlateStresses& a = model.stresses;
  a.p = Eigen::VectorXi::LinSpaced(2, 7, 8);
  a.rim_hole = {"1"};
  a.bearing_area = Eigen::RowVector2d(0.5, 0.5);
  const Index n = std::lround((to - from) / 5);
  const Index points = n < 72 ? n + 1 : n;
  a.rim_start.resize(2);
  a.rim_start << 0, static_cast<int>(points);
  a.angle = Eigen::VectorXd::LinSpaced(points, from, from + 5 * static_cast<double>(points - 1));
  Eigen::MatrixXd tt = Eigen::MatrixXd::Zero(points, 2);
  for (Index i = 0; i < points; ++i) tt(i, 0) = hoop(a.angle[i] * degree);
  a.sigma_tt = {1.01 * tt, tt};
  a.sigma_rr = {-tt, -tt};
  a.section_hole = {"1", "1"};
  a.section_side = {"+x", "-x"};
  a.gross_area = Eigen::Vector2d(2, 2);
  a.net_area = Eigen::Vector2d(1.5, 1.5);
  a.section_force = {Eigen::MatrixXd{{0, 3}, {0, 5}}, Eigen::MatrixXd{{0, 3}, {0, 5}}};
  a.stiffness_error = Eigen::Vector2d(1e-4, 1e-4);
  return model;
}

/// The state in which the first case acts twice, the second once.
RimState state(const Plate& model, const Eigen::VectorXd& bearing, const Eigen::VectorXd& friction) {
  const auto states =
      rim_states(model.stresses, model.level,
                 [](const formats::StressRows& cases) -> Eigen::VectorXd { return cases * Eigen::Vector2d(2, 1); },
                 {std::vector<std::string>(model.axes.size(), model.holes[0]), model.axes, bearing, friction});
  EXPECT_EQ(states.size(), 1U);
  return states.at(0);
}

RimState state(const Plate& model, double bearing, double friction) {
  return state(model, Eigen::VectorXd::Constant(1, bearing), Eigen::VectorXd::Constant(1, friction));
}

/// The top of cos 2 (theta - theta0) between points, for any theta0: the parabola finds it to 1e-4.
TEST(RimState, PeakBetweenPoints) {
  for (double top = -180; top < 180; top += 0.7) {
    const auto s = state(
        plate(0, 360, [&](double t) { return std::cos(t - top * degree) + 0.3 * std::cos(2 * (t - top * degree)); }), 0,
        0);
    EXPECT_NEAR(s.peak_hoop, 2 * 1.3, 2e-4) << top;
    EXPECT_NEAR(std::remainder(s.peak_angle - top, 360), 0, 0.05) << top;
    EXPECT_NEAR(s.peak_error, 0.026, 1e-3);
  }
}

TEST(RimState, PeakAtTheEndOfAQuarter) {
  const auto s = state(plate(0, 90, [](double t) { return 1 - 2 * std::cos(2 * t); }), 0, 0);
  EXPECT_DOUBLE_EQ(s.peak_hoop, 6);
  EXPECT_DOUBLE_EQ(s.peak_angle, 90);
}

/// Files made by hand may have any points: a parabola needs neighbours at equal distances.
TEST(RimState, PeakOfOddPoints) {
  auto one = plate(30, 30, [](double) { return 2.0; });
  EXPECT_DOUBLE_EQ(state(one, 0, 0).peak_hoop, 4);
  EXPECT_DOUBLE_EQ(state(one, 0, 0).peak_angle, 30);
  auto uneven = plate(0, 90, [](double t) { return std::cos(2 * (t - 46 * degree)); });
  uneven.stresses.angle[8] = 36;
  EXPECT_DOUBLE_EQ(state(uneven, 0, 0).peak_hoop, 2 * std::cos(2 * degree));
  EXPECT_DOUBLE_EQ(state(uneven, 0, 0).peak_angle, 45);
}

/// Where friction jumps, the hoop stress is singular: however large the number there, it is no peak.
TEST(RimState, NeverReportsTheJumpOfFriction) {
  const auto spike = [](double at) {
    return [at](double t) {
      return std::abs(std::remainder(t / degree - at, 360)) < 2 ? 100.0 : std::sin(t) * std::sin(t);
    };
  };
  EXPECT_DOUBLE_EQ(state(plate(0, 360, spike(0)), 1, 0.1).peak_angle, 90);
  EXPECT_DOUBLE_EQ(state(plate(0, 360, spike(180)), -1, -0.1).peak_angle, 90);
  EXPECT_DOUBLE_EQ(state(plate(0, 360, spike(0)), 1, 0).peak_hoop, 200) << "without friction it is a peak as any other";
  EXPECT_DOUBLE_EQ(state(plate(0, 360, spike(180)), 1, 0.1).peak_hoop, 200) << "friction is on the other side";
}

/// A plate as above whose disc also moves along y.
Plate plane_plate(const std::function<double(double)>& hoop) {
  Plate model = plate(0, 360, hoop);
  model.axes = {0, 1};
  return model;
}

RimState plane_state(const Plate& model, const Eigen::Vector2d& bearing, double friction_share) {
  return state(model, bearing, friction_share * bearing);
}

TEST(RimState, BearingLoadsOfBothDirections) {
  const auto s = plane_state(plane_plate([](double) { return 4.0; }), {3, -4}, 0);
  EXPECT_DOUBLE_EQ(s.bearing_load, 3);
  EXPECT_DOUBLE_EQ(s.bearing_load_y, -4);
  EXPECT_DOUBLE_EQ(s.bearing_stress, 5 / 0.5);
}

/// Bypass is along x: what the fastener takes along y leaves over no section across x.
TEST(RimState, BypassLeavesOutTheForceAlongY) {
  Plate one = plane_plate([](double) { return 4.0; });
  EXPECT_DOUBLE_EQ(plane_state(one, {2, 7}, 0).bypass_load, 3);
  EXPECT_DOUBLE_EQ(plane_state(one, {0, 7}, 0).bypass_load, 4);
  one.stresses.section_side[0] = "+y";
  EXPECT_DOUBLE_EQ(plane_state(one, {1.5, 7}, 1.0 / 3).bypass_load, 5 - 2);
}

/// Each component's friction jumps at its own bearing direction.
TEST(RimState, FrictionJumpsAtBothBearingDirections) {
  const auto spike = [](double at) {
    return [at](double t) { return std::abs(std::remainder(t / degree - at, 360)) < 2 ? 100.0 : 1.0; };
  };
  const auto found = [&](double at, double x, double y) {
    return plane_state(plane_plate(spike(at)), {x, y}, 0.1).peak_hoop > 100;
  };
  for (const double x : {1.0, -1.0})
    for (const double y : {2.0, -2.0})
      for (const double at : {0.0, 90.0, 180.0, 270.0, 45.0}) {
        const bool jumps = at == (x > 0 ? 0 : 180) || at == (y > 0 ? 90 : 270);
        EXPECT_EQ(found(at, x, y), !jumps) << at << " under " << x << ", " << y;
      }
}

/// A force along x but for rounding, or nearly, has its peak beside the hole, where y would bear.
TEST(RimState, HardlyAnyFrictionHidesNoPeak) {
  const Plate model = plane_plate([](double t) { return std::sin(t) * std::sin(t); });
  for (const double y : {0.0, 1e-14, -1e-14, 0.03})
    EXPECT_DOUBLE_EQ(std::abs(plane_state(model, {1, y}, 0.1).peak_angle), 90) << y;
  EXPECT_NEAR(plane_state(model, {1, 0.2}, 0.1).peak_angle, -90, 1e-9) << "the other side";
}

TEST(RimState, BypassIsWhatLeavesOnTheBearingSide) {
  const auto flat = [](double) { return 4.0; };
  EXPECT_DOUBLE_EQ(state(plate(0, 360, flat), 2, 0).bypass_load, 3);
  EXPECT_DOUBLE_EQ(state(plate(0, 360, flat), -2, 0).bypass_load, 5);
  EXPECT_DOUBLE_EQ(state(plate(0, 360, flat), 0, 0).bypass_load, 4);
  Plate one = plate(0, 360, flat);
  one.stresses.section_side[0] = "+y";  // only the left one is left
  EXPECT_DOUBLE_EQ(state(one, 1.5, 0.5).bypass_load, 5 - 2) << "less what the fastener takes, friction included";
  EXPECT_DOUBLE_EQ(state(one, -1.5, -0.5).bypass_load, 5);
}

TEST(RimState, BearingStressAndConcentrations) {
  const auto s = state(plate(0, 360, [](double) { return 4.0; }), -2, 0);
  EXPECT_DOUBLE_EQ(s.bearing_stress, 4);
  EXPECT_DOUBLE_EQ(s.bearing_load, -2);
  EXPECT_DOUBLE_EQ(s.gross_concentration, 8 / (5.0 / 2));
  EXPECT_DOUBLE_EQ(s.net_concentration, 8 / (5.0 / 1.5));
}

/// Springs on the right half alone: right for a fastener that pushes to +x, not for one to -x.
TEST(RimState, SpringsOnTheWrongArcPull) {
  Plate model = plate(0, 360, [](double) { return 4.0; });
  const auto radial = [&](const std::function<double(double)>& sigma) {
    for (Index i = 0; i < model.stresses.angle.size(); ++i)
      model.stresses.sigma_rr[1](i, 0) = sigma(std::cos(model.stresses.angle[i] * degree));
  };
  model.stresses.sigma_rr.assign(2, Eigen::MatrixXd::Zero(model.stresses.angle.size(), 2));
  radial([](double c) { return c > 0 ? -c : 0; });
  EXPECT_FALSE(state(model, 1, 0).pulls);
  radial([](double c) { return c > 0 ? c : 0; });
  EXPECT_TRUE(state(model, -1, 0).pulls);
  radial([](double c) { return c + 3 * (2 * c * c - 1); });  // all around, beside a large bypass load
  EXPECT_FALSE(state(model, -1, 0).pulls);
  EXPECT_FALSE(state(model, 0, 0).pulls) << "nothing to push";
}

/// A plate whose radial stress in the first case is `sigma` of the angle.
Plate pressed(double from, double to, const std::function<double(double)>& sigma) {
  Plate model = plate(from, to, [](double) { return 4.0; });
  model.stresses.sigma_rr.assign(2, Eigen::MatrixXd::Zero(model.stresses.angle.size(), 2));
  for (Index i = 0; i < model.stresses.angle.size(); ++i)
    model.stresses.sigma_rr[1](i, 0) = sigma(model.stresses.angle[i] * degree);
  return model;
}

/// The pressure p = cos + 0.2 sin + 3 cos 2, twice, acts over d t = 0.5: the force along x is 2 pi / 2 d t, across it a
/// fifth.
TEST(RimState, ForceAcrossIsThatOfThePressure) {
  const auto sigma = [](double t) { return -std::cos(t) - 0.2 * std::sin(t) - 3 * std::cos(2 * t); };
  const double along = std::numbers::pi * 0.5;
  const auto s = state(pressed(0, 360, sigma), along, 0);
  EXPECT_NEAR(s.across, 0.2 * along, 1e-12);
  EXPECT_NEAR(s.across_share, 0.2, 1e-12);
  Plate y = pressed(0, 360, sigma);
  y.axes = {1};
  EXPECT_NEAR(state(y, 0.2 * along, 0).across, along, 1e-12);
}

TEST(RimState, NothingIsKnownToHoldADiscAcrossOnALineOfSymmetryOrInThePlane) {
  const auto sigma = [](double t) { return -std::sin(t); };
  EXPECT_TRUE(std::isnan(state(pressed(0, 180, sigma), 1, 0).across)) << "symmetry holds it";
  Plate both = pressed(0, 360, sigma);
  both.axes = {0, 1};
  EXPECT_TRUE(std::isnan(plane_state(both, {1, 0}, 0).across)) << "it moves";
  Plate open = pressed(0, 360, sigma);
  open.stresses.rim_hole = {"open"};
  EXPECT_TRUE(std::isnan(state(open, 1, 0).across)) << "no disc";
}

TEST(RimState, SpringsAllAroundPullOnTheSideThatDoesNotBear) {
  const auto all = state(pressed(0, 360, [](double t) { return -std::cos(t + 0.01) - 0.5; }), 1, 0);
  EXPECT_TRUE(all.filled);
  EXPECT_NEAR(all.pull, 1, 1e-2);
  const auto arc = state(pressed(0, 360, [](double t) { return -std::max(std::cos(t), 0.0); }), 1, 0);
  EXPECT_FALSE(arc.filled);
  EXPECT_EQ(arc.pull, 0);
  EXPECT_FALSE(state(pressed(0, 360, [](double) { return 0.0; }), 1, 0).filled) << "an open hole";
}

TEST(RimState, NoConcentrationOnAnUnloadedSection) {
  Plate model = plate(0, 360, [](double) { return 4.0; });
  model.stresses.section_force[1].setZero();
  EXPECT_EQ(state(model, 1, 0).gross_concentration, 0);
  EXPECT_TRUE(std::isfinite(state(model, 0, 0).net_concentration));
}

/// Two degrees of a coarse mesh may agree by accident; the sheet's stiffness still shows how coarse it is.
TEST(RimState, BypassErrsAtLeastAsMuchAsTheSheet) {
  Plate model = plate(0, 360, [](double) { return 4.0; });
  EXPECT_EQ(state(model, 1, 0).bypass_load, 3);
  EXPECT_DOUBLE_EQ(state(model, 1, 0).bypass_error, 1e-2 * 5);
  model.stresses.section_force[0] *= 1.1;
  EXPECT_NEAR(state(model, 1, 0).bypass_error, 0.3, 1e-14);
}

TEST(RimState, OneDegreeAloneKnowsNoError) {
  Plate model = plate(0, 360, [](double) { return 4.0; });
  model.level = 0;
  EXPECT_EQ(state(model, 1, 0).peak_error, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace fastjoint::stage3
