// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/load_path.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/path/walk.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3::event_path_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::ground;
using testing::ElementsAre;

constexpr ContactEvent closes(Index plane) { return {plane, CornerKind::contact, false}; }
constexpr ContactEvent opens(Index plane) { return {plane, CornerKind::contact, true}; }

/// The joint of load_path_test.cpp: contact at P* = g / (1/K + f) = 40, whatever the law of the second fastener beyond
/// its gap.
class GapAtTheSecondFastener : public testing::TestWithParam<double> {};

TEST_P(GapAtTheSecondFastener, IncrementIsAtTheLoadOfTheClosedForm) {
  constexpr double K = 2000, f = 1e-3, g = 0.06, contact_load = g / (1 / K + f);
  auto joint = test::joint_of(test::two_fastener_lap(), test::linear_law(K));
  joint.law[1] = test::power_law(300, GetParam());
  joint.clearance[1] = g;
  const LoadPath path = follow_events(make_equations(joint), {});
  ASSERT_FALSE(path.failure);
  ASSERT_EQ(path.steps.size(), 2U);
  EXPECT_EQ(path.n_increments, 2U);
  EXPECT_NEAR(100 * path.steps[0].load_factor, contact_load, 1e-9 * contact_load);
  EXPECT_NEAR(path.steps[0].delta[1], g, 1e-12 * g);
  EXPECT_NEAR(path.steps[0].F[1], 0, 1e-12 * 100);
  EXPECT_THAT(path.steps[0].events, ElementsAre(closes(1)));
  EXPECT_EQ(path.steps[1].load_factor, 1);
  EXPECT_THAT(path.steps[1].events, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(OfExponents, GapAtTheSecondFastener, testing::Values(1.0, 0.9, 0.5, 0.3));

/// Three equal strands from ground to load, each with a gap, beside a spring that holds the loaded end.
test::HandMade strands(const std::shared_ptr<const Law>& law, const std::array<double, 3>& gaps) {
  constexpr double k = 1000, hold = 200;
  auto joint = test::joint_of({test::spring_plate(3, 1, {{0, 3, k}, {1, 3, k}, {2, 3, k}, {3, ground, hold}}),
                               test::spring_plate(3, 0, {{0, ground, k}, {1, ground, k}, {2, ground, k}}), 300},
                              law);
  for (Index j = 0; j < 3; ++j) joint.clearance[j] = gaps[j];
  return joint;
}

TEST(Events, OfOneFastenerAreToldApartThoughItsPlatesFloat) {
  // S_ud is what rounding leaves of the first plate's stiffness, in any units.
  for (const double force : {1.0, 1e-6, 1e6})
    for (const double length : {1.0, 1e-4, 1e4}) {
      const double k = force / length;
      const auto law = read_law(input::Value(input::parse(
          "law", fmt::format(R"({{"type": "four stage", "k_stick": {}, "F_slip": {}, "slip": {}, "k_bearing": {},
                                  "F_yield": {}, "k_yield": {}}})",
                             2e6 * k, 350 * force, 2.5e-4 * length, 4e5 * k, 700 * force, 1e4 * k))));
      const auto joint =
          test::joint_of({test::spring_plate(1, 2, {{0, 1, 123456.7 * k}, {1, 2, 7890.1 * k}, {0, 2, 3333.3 * k}}),
                          test::spring_plate(1, 0, {{0, ground, 54321 * k}}), 1000 * force},
                         law);
      const JointEquations equations = make_equations(joint);
      EXPECT_GT(equations.contacts[0].stiffness, 1e4 * k);
      const LoadPath path = follow_events(equations, {});
      ASSERT_EQ(path.steps.size(), 3U);
      EXPECT_EQ(event_text(joint, path.steps[0].events), "1 slips; 1 closes");
      EXPECT_EQ(event_text(joint, path.steps[1].events), "1 yields");
      EXPECT_NEAR(path.steps[1].load_factor, 0.7, 1e-12);
    }
}

TEST(Events, AreToldByName) {
  const auto joint =
      test::joint_of({test::chain(2, 1, 1000, {{1, 2, 1000}}), test::chain(2, 0, 1000, {}), 0}, test::linear_law(1));
  const auto text = [&](CornerKind corner, bool back) {
    return event_text(joint, {{0, corner, back}}) + ", " + event_text(joint, {{0, corner, back}, {1, corner, back}});
  };
  EXPECT_EQ(text(CornerKind::slip, false), "1 slips, 1, 2 slip");
  EXPECT_EQ(text(CornerKind::slip, true), "1 sticks again, 1, 2 stick again");
  EXPECT_EQ(text(CornerKind::contact, false), "1 closes, 1, 2 close");
  EXPECT_EQ(text(CornerKind::contact, true), "1 opens, 1, 2 open");
  EXPECT_EQ(text(CornerKind::yield, false), "1 yields, 1, 2 yield");
  EXPECT_EQ(text(CornerKind::yield, true), "1 is elastic again, 1, 2 are elastic again");
  EXPECT_EQ(event_text(joint, {{1, CornerKind::contact, true}, {0, CornerKind::yield, false}}), "1 yields; 2 opens");
}

TEST(Events, EqualGapsCloseTogetherAndSmallerOnesBefore) {
  for (const auto& law : {test::linear_law(3000), test::power_law(3000, 0.7)}) {
    const LoadPath together = follow_events(make_equations(strands(law, {0.01, 0.01, 0.01})), test::tight);
    ASSERT_EQ(together.steps.size(), 2U);
    EXPECT_NEAR(300 * together.steps[0].load_factor, 200 * 0.01, 1e-9);
    EXPECT_THAT(together.steps[0].events, ElementsAre(closes(0), closes(1), closes(2)));
    const LoadPath pair = follow_events(make_equations(strands(law, {0.02, 0.01, 0.02})), test::tight);
    ASSERT_EQ(pair.steps.size(), 3U);
    EXPECT_NEAR(300 * pair.steps[0].load_factor, 200 * 0.01, 1e-9);
    EXPECT_THAT(pair.steps[0].events, ElementsAre(closes(1)));
    EXPECT_THAT(pair.steps[1].events, ElementsAre(closes(0), closes(2)));
  }
}

TEST(Events, CornersOfFourStagesAreNamed) {
  const auto law = read_law(input::Value(input::parse(
      "law", R"({"type": "four stage", "k_stick": 4000, "F_slip": 5, "slip": 0.002, "k_bearing": 2000, "F_yield": 40,
                 "k_yield": 100})")));
  auto lap = test::Lap{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, ground, 1000}}), 100};
  auto joint = test::joint_of(lap, law);
  joint.clearance[0] = 0.01;
  const LoadPath path = follow_events(make_equations(joint), {});
  // One fastener carries it all: corners at its forces; it slips and bears at the same load.
  ASSERT_EQ(path.steps.size(), 3U);
  EXPECT_NEAR(path.steps[0].load_factor, 0.05, 1e-12);
  EXPECT_NEAR(path.steps[1].load_factor, 0.40, 1e-12);
  EXPECT_EQ(event_text(joint, path.steps[0].events), "1 slips; 1 closes");
  EXPECT_EQ(event_text(joint, path.steps[1].events), "1 yields");
}

/// Two planes with S = [[2, -1], [-1, 2]] s and q = (1, -r) Q: the second closes first, and opens again after the first
/// has closed, where F_2 = 0: delta_1 = 2 g_2 + r lambda Q / s from its row, K (delta_1 - g_1) + 2 s delta_1 - s g_2 =
/// lambda Q from the other. The second fastener's law has no part in that.
TEST(Events, LostContactIsAnEventToo) {
  constexpr double s = 1000, Q = 100, r = 0.2, K = 1e6, g1 = 0.02, g2 = 0.006;
  for (const auto& law : {test::linear_law(100), test::power_law(100, 0.8)}) {
    const JointEquations equations = test::equations_of(
        s * Eigen::Matrix2d{{2, -1}, {-1, 2}}, Q * Eigen::Vector2d(1, -r), {{test::linear_law(K), g1}, {law, g2}});
    const LoadPath path = follow_events(equations, test::tight);
    ASSERT_EQ(path.steps.size(), 4U);
    EXPECT_THAT(path.steps[0].events, ElementsAre(closes(1)));
    EXPECT_THAT(path.steps[1].events, ElementsAre(closes(0)));
    EXPECT_THAT(path.steps[2].events, ElementsAre(opens(1)));
    EXPECT_NEAR(path.steps[0].load_factor, g2 * 3 * s / (Q * (1 - 2 * r)), 1e-9) << "S delta = lambda q";
    const double opening = (K * (g1 - 2 * g2) - 3 * s * g2) / ((K + 2 * s) * r * Q / s - Q);
    EXPECT_NEAR(path.steps[2].load_factor, opening, 1e-9);
  }
}

/// At each event the planes named are on a mark; between events no stage changes, by states solved in between.
void expect_all_events(const JointEquations& equations, const LoadPath& path, bool floats, int samples, int joint) {
  ASSERT_FALSE(path.failure) << "joint " << joint;
  const ContactCorners corners(equations);
  const double scale = force_scale(equations, 1);
  Walk walk(equations, test::tight);
  double begin = first_load_factor;
  for (const auto& step : path.steps) {
    EXPECT_LE(step.residual, 1e-10) << "joint " << joint;
    bool one_is_exact = step.events.empty();
    for (const auto& event : step.events) {
      const Contact& contact = equations.contacts[event.plane];
      one_is_exact |= event.kind != CornerKind::contact || step.check.mechanism;
      if (event.kind != CornerKind::contact || step.check.mechanism) continue;
      const double gap = contact.law->gap(contact.clearance);
      const double away = std::abs(std::abs(step.delta[event.plane]) - gap);
      one_is_exact |= away <= 1e-9 * gap + 1e-15;
      // Load factors that differ by 1e-9 are one event to the search, put where the first is: the others are not on
      // their corners by what discs move over that much load.
      const double joined = step.events.size() > 1 ? 1e-9 * step.delta.cwiseAbs().maxCoeff() / step.load_factor : 0;
      EXPECT_LE(away, 1e-9 * gap + joined + 1e-15) << "joint " << joint;
      // A sheet that floats jumps to its hold, to the resolution of the search.
      const bool is_curved = !contact.law->corners(1, 0);
      const double most = !is_curved ? step.F.cwiseAbs().maxCoeff() : floats ? 1e-9 * scale : 0;
      EXPECT_LE(std::abs(step.F[event.plane]), most) << "joint " << joint;
    }
    EXPECT_TRUE(one_is_exact) << "joint " << joint;
    std::optional<Eigen::VectorXi> passed;
    const double length = step.load_factor - begin;
    for (int k = 0; k < samples && length > 1e-6; ++k) {
      ASSERT_TRUE(walk.reach(begin + length * (k + 0.5) / samples));
      if (walk.step().check.mechanism) break;  // whether a sheet touches within its gaps is not determined
      const Eigen::VectorXi here = corners.passed(walk.here().c);
      EXPECT_EQ(here, passed.value_or(here)) << "joint " << joint << " before " << step.load_factor;
      passed = here;
    }
    begin = step.load_factor;
  }
  EXPECT_EQ(path.steps.back().load_factor, 1);
}

class RandomEvents : public testing::TestWithParam<test::RandomJoint> {};

TEST_P(RandomEvents, AreAllFound) {
  std::mt19937 random(92);
  constexpr int joints = 60, samples = 20;
  Index events = 0;
  for (int i = 0; i < joints; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, GetParam()));
    const LoadPath path = follow_events(equations, test::tight);
    events += path.steps.size() - 1;
    expect_all_events(equations, path, GetParam().floating, samples, i);
  }
  EXPECT_GT(events, joints / 2U);
}

INSTANTIATE_TEST_SUITE_P(Of, RandomEvents,
                         testing::Values(test::RandomJoint{}, test::RandomJoint{.cubics = true},
                                         test::RandomJoint{.friction = true}, test::RandomJoint{.one_sided = true},
                                         test::RandomJoint{.floating = true}, test::RandomJoint{.least_n = 0.1},
                                         test::RandomJoint{.friction = true, .piecewise = true},
                                         test::RandomJoint{.one_sided = true, .piecewise = true}));

/// The search by solved states finds the corners of the exact path.
TEST(Events, OfPiecewiseLinearJointsAreTheCornersOfTheExactPath) {
  std::mt19937 random(93);
  for (int i = 0; i < 60; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {.friction = true, .piecewise = true}));
    const ContactCorners corners(equations);
    const ExactPath exact = exact_path(equations, 1);
    std::vector<double> loads;  // at which planes pass corners; a rim's side changes where a plane passes none
    for (std::size_t k = 1; k < exact.pieces.size(); ++k) {
      const auto passed = [&](const PathPiece& piece) {
        return corners.passed(exact.at(0.5 * (piece.begin + piece.end)));
      };
      if (exact.pieces[k].begin > first_load_factor && passed(exact.pieces[k]) != passed(exact.pieces[k - 1]))
        loads.push_back(exact.pieces[k].begin);
    }
    const LoadPath found = follow_events(equations, test::tight);
    ASSERT_EQ(found.steps.size(), loads.size() + 1) << "joint " << i;
    for (std::size_t k = 0; k < loads.size(); ++k) EXPECT_NEAR(found.steps[k].load_factor, loads[k], 1e-8) << i;
  }
}

/// One plane with a circle of clearance g and S = diag(s_x, s_y): it bears where |(q_x / s_x, q_y / s_y)| lambda = g.
TEST(Events, ClearanceOfDiscsWithTwoDirectionsIsACircle) {
  constexpr double s_x = 1000, s_y = 500, q_x = 30, q_y = 40, g = 0.05;
  for (const auto& law : {test::linear_law(2000), test::power_law(300, 0.5)}) {
    const Eigen::Matrix2d S_ud = Eigen::Vector2d(s_x, s_y).asDiagonal();
    const LoadPath path = follow_events(test::equations_of(S_ud, Eigen::Vector2d(q_x, q_y), {{law, g}}), test::tight);
    ASSERT_EQ(path.steps.size(), 2U);
    EXPECT_THAT(path.steps[0].events, ElementsAre(closes(0)));
    EXPECT_NEAR(path.steps[0].load_factor, g / std::hypot(q_x / s_x, q_y / s_y), 1e-10);
    EXPECT_NEAR(path.steps[0].delta.norm(), g, 1e-12 * g);
  }
}

/// The amount of a vector is rounded, but at its event a fastener is on the side of its corner on which it bears more.
TEST(Events, OfDiscsWithTwoDirectionsAreOnTheSideThatBears) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> number(0.1, 1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d q = 100 * Eigen::Vector2d(number(random), number(random));
    const Eigen::Matrix2d S_ud = 1000 * Eigen::Vector2d(number(random), number(random)).asDiagonal();
    const JointEquations equations = test::equations_of(S_ud, q, {{test::linear_law(3000), 0.05 * number(random)}});
    const LoadPath path = follow_events(equations, test::tight);
    if (path.steps.size() < 2) continue;
    const double k = equations.contacts[0].stiffness;
    EXPECT_NEAR(contact_state(equations, path.steps[0].c).along(&Response::dF, 0), 3000 / (3000 + k), 1e-12) << i;
  }
}

TEST(Events, GivenLoadFactorsThatHitOneSaySo) {
  const auto joint = strands(test::linear_law(3000), {0.02, 0.01, 0.02});
  const JointEquations equations = make_equations(joint);
  const double first = 200 * 0.01 / 300;
  const LoadPath path = follow(equations, {0.5 * first, first, 2 * first, first, -first}, {});
  std::vector<std::string> texts;
  texts.reserve(path.steps.size());
  for (const auto& step : path.steps) texts.push_back(event_text(joint, step.events));
  EXPECT_THAT(texts, ElementsAre("", "2 closes", "", "2 opens", "2 closes"));
}

TEST(Events, SearchEndsWhereTheJointDoes) {
  const auto lap =
      test::Lap{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, ground, 1000}}), 4};
  auto joint = test::joint_of(lap, test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4}));
  const LoadPath path = follow_events(make_equations(joint), {});
  ASSERT_TRUE(path.failure) << "it carries 3.025 at most";
  EXPECT_EQ(path.failure->load_factor, 0.875);
  EXPECT_EQ(path.n_increments, 1U);
}

}  // namespace
}  // namespace fastjoint::stage3::event_path_test
