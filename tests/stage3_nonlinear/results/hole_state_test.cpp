// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hole_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "common/pfem/material.hpp"

namespace fastjoint::stage3 {
namespace hole_state_test {

using Eigen::Index;

constexpr double degree = std::numbers::pi / 180;

/// Angular function as a sum of few waves; what the rim's displacement and pressure are made of.
using Function = std::function<double(double)>;

constexpr double rim_radius = 2, E = 10;
constexpr int highest = 6;

struct Plate {
  std::vector<std::string> holes;
  std::vector<int> axes;
  formats::PlateStresses stresses;
  std::optional<LoadedRim> rim;
  int level;
};

/// Displacement of a disc that stands still against the sheet around an open hole whose hoop stress is `hoop`. With
/// Kolosov's potential phi it is 4 Re phi', and the rim moves by 4 phi / E: a hoop stress cos k theta is that of
/// z^(1-k) / (4 (1 - k)), or z^2 / 8 where k = 1.
Eigen::VectorXd displacement(const rim::Harmonics& waves, const Function& hoop) {
  const rim::Harmonics whole{waves.highest};
  constexpr int n = 3600;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(whole.size());
  for (int i = 0; i < n; ++i) {
    const double angle = (i + 0.5) / n * rim::full_turn;
    f += hoop(angle) / n * whole.at(angle);
  }
  Eigen::VectorXd normal = f, along = Eigen::VectorXd::Zero(f.size());
  for (int k = 1; k <= whole.highest; ++k) {
    const double part = k == 1 ? -2.0 : 1.0 - k;
    normal.segment<2>(2 * k - 1) = f.segment<2>(2 * k - 1) / std::abs(part) * (k == 1 ? 1 : -1);
    along.segment<2>(2 * k - 1) << f[2 * k] / part, -f[2 * k - 1] / part;
  }
  Eigen::VectorXd result(waves.size() + waves.n_shears());
  result << waves.pressures_of_whole().transpose() * normal, waves.shears_of_whole().transpose() * along;
  return -rim_radius / E * result;
}

/// A rim in a sheet whose hoop stress is `hoop`, 1 % more at the degree below.
LoadedRim loaded(const rim::Harmonics& waves, const Function& hoop) {
  formats::WaveRim rim{"1", waves, rim_radius, 1, 0};
  rim.compliance = pfem::elasticity(pfem::isotropic(E, 0.3), 0, pfem::Analysis::plane_stress).inverse();
  const Eigen::VectorXd w = displacement(waves, hoop);
  const Tractions none = [](double) -> Eigen::Vector2d { return {0, 0}; };
  return {rim, {{w, none}, {1.01 * w, none}}, false, {}};
}

/// A plate with the disc "1" and two cases; its hoop stress is `hoop`; sections carry 3 (right) and 5 (left) times the
/// second case.
Plate plate(const rim::Harmonics& waves, const Function& hoop) {
  Plate model{{"1"}, {0}, {}, loaded(waves, hoop), 1};
  formats::PlateStresses& a = model.stresses;
  a.p = Eigen::VectorXi::LinSpaced(2, 7, 8);
  a.rim_hole = {"1"};
  a.bearing_area = Eigen::RowVector2d(0.5, 0.5);
  a.section_hole = {"1", "1"};
  a.section_side = {"+x", "-x"};
  a.gross_area = Eigen::Vector2d(2, 2);
  a.net_area = Eigen::Vector2d(1.5, 1.5);
  a.section_force = {Eigen::MatrixXd{{0, 3}, {0, 5}}, Eigen::MatrixXd{{0, 3}, {0, 5}}};
  a.section_shear = {Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 2)};
  a.stiffness_error = Eigen::Vector2d(1e-4, 1e-4);
  return model;
}

Plate plate(const Function& hoop) { return plate({highest}, hoop); }
Plate flat() {
  return plate([](double) { return 8.0; });
}

/// The state in which the second case acts once.
HoleState state(const Plate& model, const Eigen::VectorXd& bearing, const Eigen::VectorXd& friction) {
  const auto states = hole_states(
      model.stresses, {}, model.level, Eigen::Vector2d(2, 1),
      {std::vector<std::string>(model.axes.size(), model.holes[0]), model.axes, bearing, friction}, 0, {model.rim});
  EXPECT_EQ(states.size(), 1U);
  return states.at(0);
}

HoleState state(const Plate& model, double bearing, double friction) {
  return state(model, Eigen::VectorXd::Constant(1, bearing), Eigen::VectorXd::Constant(1, friction));
}

/// The top of a function between points, wherever it is.
TEST(HoleState, PeakBetweenPoints) {
  for (double top = -180; top < 180; top += 0.7) {
    const auto s = state(
        plate([&](double t) { return std::cos(t - top * degree) + 0.3 * std::cos(2 * (t - top * degree)); }), 0, 0);
    EXPECT_NEAR(s.peak_hoop, 1.3, 1e-8) << top;
    EXPECT_NEAR(std::remainder(s.peak_angle - top, 360), 0, 1e-3) << top;
    EXPECT_GT(s.peak_error, 2 * 0.013 * (1 - 1e-4)) << "twice the change from the degree below";
    EXPECT_LT(s.peak_error, 2 * 0.013 * 1.01);
  }
}

TEST(HoleState, PeakAtTheEndOfAQuarter) {
  const auto s = state(plate({highest, 0, rim::full_turn / 4}, [](double t) { return 1 - 2 * std::cos(2 * t); }), 0, 0);
  EXPECT_NEAR(s.peak_hoop, 3, 1e-8);
  EXPECT_NEAR(s.peak_angle, 90, 1e-3);
}

/// Waves that are told from long to short: where each pair falls to half of the one before, all to come are as much as
/// the last pair.
TEST(HoleState, ErrorHasWhatTheWavesLeaveOut) {
  constexpr int n = 11;
  Plate model = plate({n}, [](double t) {
    double sum = 0;
    for (int k = 0; k <= n; ++k) sum += std::pow(2, -k / 2.0) * std::cos(k * t);
    return sum;
  });
  model.rim->degrees[1] = model.rim->degrees[0];
  const double left_out = std::pow(2, -n / 2.0) / (std::sqrt(2) - 1), error = state(model, 0, 0).peak_error;
  EXPECT_GT(error, 0.99 * left_out);
  EXPECT_LT(error, 3 * left_out);
}

/// Where friction jumps, the hoop stress is singular: however large the number there, it is no peak.
TEST(HoleState, NeverReportsTheJumpOfFriction) {
  const auto top = [](double at) { return plate([at](double t) { return std::cos(t - at * degree); }); };
  const auto off = [&](double at, double force, double friction) {
    return std::abs(std::remainder(state(top(at), force, friction).peak_angle - at, 360));
  };
  EXPECT_NEAR(off(0, 1, 0.1), 7.5, 0.5);
  EXPECT_NEAR(off(180, -1, -0.1), 7.5, 0.5);
  EXPECT_NEAR(off(0, 1, 0), 0, 1e-3) << "without friction it is a peak as any other";
  EXPECT_NEAR(off(180, 1, 0.1), 0, 1e-3) << "friction is on the other side";
}

/// A plate as above whose disc also moves along y.
Plate plane_plate(const Function& hoop) {
  Plate model = plate(hoop);
  model.axes = {0, 1};
  return model;
}

HoleState plane_state(const Plate& model, const Eigen::Vector2d& bearing, double friction_share) {
  return state(model, bearing, friction_share * bearing);
}

TEST(HoleState, BearingLoadsOfBothDirections) {
  const auto s = plane_state(plane_plate([](double) { return 8.0; }), {3, -4}, 0);
  EXPECT_DOUBLE_EQ(s.bearing_load, 3);
  EXPECT_DOUBLE_EQ(s.bearing_load_y, -4);
  EXPECT_DOUBLE_EQ(s.bearing_stress, 5 / 0.5);
}

/// A hole with sections across x alone does not know what its fastener's force along y leaves.
TEST(HoleState, BypassIsUnknownAlongAnAxisWithoutSections) {
  const Plate one = plane_plate([](double) { return 8.0; });
  EXPECT_DOUBLE_EQ(plane_state(one, {2, 1e-6}, 0).bypass_load, 3);
  const auto s = plane_state(one, {2, 7}, 0);
  EXPECT_TRUE(std::isinf(s.bypass_load) && std::isinf(s.bypass_stress) && std::isinf(s.net_stress));
  EXPECT_EQ(s.gross_concentration, 0);
}

/// Each component's friction jumps at its own bearing direction.
TEST(HoleState, FrictionJumpsAtBothBearingDirections) {
  const auto found = [&](double at, double x, double y) {
    const auto s = plane_state(plane_plate([at](double t) { return std::cos(t - at * degree); }), {x, y}, 0.1);
    return std::abs(std::remainder(s.peak_angle - at, 360)) < 1;
  };
  for (const double x : {1.0, -1.0})
    for (const double y : {2.0, -2.0})
      for (const double at : {0.0, 90.0, 180.0, 270.0, 45.0}) {
        const bool jumps = at == (x > 0 ? 0 : 180) || at == (y > 0 ? 90 : 270);
        EXPECT_EQ(found(at, x, y), !jumps) << at << " under " << x << ", " << y;
      }
}

/// A force along x but for rounding, or nearly, has its peak beside the hole, where y would bear.
TEST(HoleState, HardlyAnyFrictionHidesNoPeak) {
  const Plate model = plane_plate([](double t) { return std::sin(t) * std::sin(t); });
  for (const double y : {0.0, 1e-14, -1e-14, 0.03})
    EXPECT_NEAR(std::abs(plane_state(model, {1, y}, 0.1).peak_angle), 90, 1e-3) << y;
  EXPECT_NEAR(plane_state(model, {1, 0.2}, 0.1).peak_angle, -90, 1e-3) << "the other side";
}

TEST(HoleState, BypassIsWhatLeavesOnTheBearingSide) {
  EXPECT_DOUBLE_EQ(state(flat(), 2, 0).bypass_load, 3);
  EXPECT_DOUBLE_EQ(state(flat(), -2, 0).bypass_load, 5);
  EXPECT_DOUBLE_EQ(state(flat(), 0, 0).bypass_load, 4);
  Plate one = flat();
  one.stresses.section_hole[0] = "2";  // only the left one is left
  EXPECT_DOUBLE_EQ(state(one, 1.5, 0.5).bypass_load, 5 - 2) << "less what the fastener takes, friction included";
  EXPECT_DOUBLE_EQ(state(one, -1.5, -0.5).bypass_load, 5);
}

TEST(HoleState, BearingStressAndConcentrations) {
  const auto s = state(flat(), -2, 0);
  EXPECT_DOUBLE_EQ(s.bearing_stress, 4);
  EXPECT_DOUBLE_EQ(s.bearing_load, -2);
  EXPECT_NEAR(s.gross_concentration, 8 / (5.0 / 2), 1e-9);
  EXPECT_NEAR(s.net_concentration, 8 / (5.0 / 1.5), 1e-9);
}

/// A plate whose rim has this pressure.
Plate pressed(const rim::Harmonics& waves, const Function& pressure) {
  Plate model = plate(waves, [](double) { return 8.0; });
  model.rim->degrees[0].tractions = [=](double angle) -> Eigen::Vector2d { return {pressure(angle), 0}; };
  return model;
}
Plate pressed(const Function& pressure) { return pressed({highest}, pressure); }

/// Springs on the right half alone: right for a fastener that pushes to +x, not for one to -x.
TEST(HoleState, SpringsOnTheWrongArcPull) {
  EXPECT_FALSE(state(pressed([](double t) { return std::max(std::cos(t), 0.0); }), 1, 0).pulls);
  const Plate wrong = pressed([](double t) { return -std::max(std::cos(t), 0.0); });
  EXPECT_TRUE(state(wrong, -1, 0).pulls);
  const Plate around =
      pressed([](double t) { return -std::cos(t) - 3 * std::cos(2 * t); });  // beside a large bypass load
  EXPECT_FALSE(state(around, -1, 0).pulls);
  EXPECT_FALSE(state(around, 0, 0).pulls) << "nothing to push";
}

/// The pressure p = 2 (cos + 0.2 sin + 3 cos 2) acts over d t = 0.5: the force along x is pi d t, across it a fifth.
TEST(HoleState, ForceAcrossIsThatOfThePressure) {
  const auto pressure = [](double t) { return 2 * (std::cos(t) + 0.2 * std::sin(t) + 3 * std::cos(2 * t)); };
  const double along = std::numbers::pi * 0.5;
  const auto s = state(pressed(pressure), along, 0);
  EXPECT_NEAR(s.across, 0.2 * along, 1e-12);
  EXPECT_NEAR(s.across_ratio, 0.2, 1e-12);
  Plate y = pressed(pressure);
  y.axes = {1};
  EXPECT_NEAR(state(y, 0.2 * along, 0).across, along, 1e-12);
}

TEST(HoleState, NothingIsKnownToHoldADiscAcrossOnALineOfSymmetryOrInThePlane) {
  const auto pressure = [](double t) { return std::sin(t); };
  EXPECT_TRUE(std::isnan(state(pressed({highest, 0, rim::full_turn / 2}, pressure), 1, 0).across))
      << "symmetry holds it";
  Plate both = pressed(pressure);
  both.axes = {0, 1};
  EXPECT_TRUE(std::isnan(plane_state(both, {1, 0}, 0).across)) << "it moves";
  Plate open = pressed(pressure);
  open.stresses.rim_hole = {"open"};
  open.rim->rim.hole = "open";
  EXPECT_TRUE(std::isnan(state(open, 1, 0).across)) << "no disc";
}

TEST(HoleState, SpringsAllAroundPullOnTheSideThatDoesNotBear) {
  const auto all = state(pressed([](double t) { return std::cos(t + 0.01) + 0.5; }), 1, 0);
  EXPECT_TRUE(all.filled);
  EXPECT_NEAR(all.pull, 0.5, 1e-2);
  const auto arc = state(pressed([](double t) { return std::max(std::cos(t), 0.0); }), 1, 0);
  EXPECT_FALSE(arc.filled);
  EXPECT_EQ(arc.pull, 0);
  EXPECT_FALSE(state(pressed([](double) { return 0.0; }), 1, 0).filled) << "an open hole";
}

TEST(HoleState, NoConcentrationOnAnUnloadedSection) {
  Plate model = flat();
  model.stresses.section_force[1].setZero();
  EXPECT_EQ(state(model, 1, 0).gross_concentration, 0);
  EXPECT_TRUE(std::isfinite(state(model, 0, 0).net_concentration));
}

/// Two degrees of a coarse mesh may agree by accident; the sheet's stiffness still shows how coarse it is.
TEST(HoleState, BypassErrsAtLeastAsMuchAsTheSheet) {
  Plate model = flat();
  EXPECT_EQ(state(model, 1, 0).bypass_load, 3);
  EXPECT_DOUBLE_EQ(state(model, 1, 0).bypass_error, 1e-2 * 5);
  model.stresses.section_force[0] *= 1.1;
  EXPECT_NEAR(state(model, 1, 0).bypass_error, 0.3, 1e-14);
}

TEST(HoleState, OneDegreeAloneKnowsNoError) {
  Plate model = flat();
  model.level = 0;
  model.rim->degrees.pop_back();
  EXPECT_EQ(state(model, 1, 0).peak_error, std::numeric_limits<double>::infinity());
}

TEST(HoleState, NoPeakIsKnownWithoutWaves) {
  Plate model = flat();
  model.rim.reset();
  EXPECT_TRUE(std::isnan(state(model, 1, 0).peak_hoop));
  EXPECT_EQ(state(model, 1, 0).net_concentration, 0);
  EXPECT_EQ(state(model, 1, 0).peak_error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(state(model, 1, 0).bypass_load, 3);
}

}  // namespace hole_state_test
}  // namespace fastjoint::stage3
