// SPDX-License-Identifier: GPL-3.0-or-later
// Events of rims that push but do not pull.
#include <gtest/gtest.h>

#include <limits>

#include <algorithm>

#include <cmath>
#include <optional>

#include "stage3_nonlinear/path/walk.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/sweep.hpp"

namespace fastjoint::stage3 {
namespace {

/// At its event a rim loses full contact, or has come to touch since a millionth of the load before, and between events
/// nothing passes a mark, by states solved in between.
TEST_F(ContactJoint, HaveAnIncrementAtEveryEvent) {
  int events = 0;
  for (int i = 0; i < test::scenes(24); ++i) {
    const test::HandMade joint =
        random_contact_joint(random_, {1 + i % 4, 1 + i % 2, false, decades(random_, 0.01, 1)});
    const JointEquations equations = make_equations(joint);
    const ContactCorners corners(equations);
    const LoadPath path = follow_events(equations, test::tight);
    ASSERT_FALSE(path.failure) << "joint " << i;
    Walk walk(equations, test::tight);
    double begin = first_load_factor;
    for (const auto& step : path.steps) {
      const VectorXd& c = step.c;
      for (const auto& event : step.events) {
        if (event.kind != CornerKind::touch && event.kind != CornerKind::part) continue;
        ++events;
        if (event.kind == CornerKind::part) {
          EXPECT_LE(std::abs(corners.position(c, event.plane)), 1e-8 * c.cwiseAbs().maxCoeff()) << "joint " << i;
          continue;
        }
        constexpr double before = 2e-6;
        if (step.load_factor - before <= first_load_factor) continue;
        ASSERT_TRUE(walk.reach(step.load_factor - before));
        EXPECT_EQ(corners.passed(c)[event.plane], event.back ? 0 : 1) << "joint " << i;
        EXPECT_EQ(corners.passed(walk.here().c)[event.plane], event.back ? 1 : 0) << "joint " << i;
      }
      std::optional<Eigen::VectorXi> passed;
      for (int sample = 1; sample < 10 && step.load_factor - begin > 1e-4; ++sample) {
        ASSERT_TRUE(walk.reach(begin + sample * (step.load_factor - begin) / 10));
        Eigen::VectorXi here = corners.passed(walk.here().c);
        for (Index entry = equations.n_planes(); entry < here.size(); ++entry) {  // a loose bolt lies anywhere
          const CompressionOnlyRim& rim = equations.rims[(entry - equations.n_planes()) / 2]->contact();
          const double near = 1e-4 * rim.stiffness() * std::abs(rim.gap());
          if (passed && std::abs(corners.position(walk.here().c, entry)) < near) here[entry] = (*passed)[entry];
        }
        EXPECT_EQ(here, passed.value_or(here)) << "joint " << i << " at " << walk.here().load_factor;
        passed = here;
      }
      begin = step.load_factor;
    }
  }
  EXPECT_GE(events, test::scenes(60));
}

/// What rims do between increments is told at the next, and undone on the way back.
TEST_F(ContactJoint, TellWhatTheirRimsHaveDoneByAnIncrement) {
  const test::HandMade joint = random_contact_joint(random_, {3, 2, false, 1});
  const JointEquations equations = make_equations(joint);
  const ContactCorners corners(equations);
  const LoadPath path = follow(equations, {0.2, 0.4, 0.6, 0.8, 1, 0.2}, {});
  ASSERT_FALSE(path.failure);
  ASSERT_TRUE(path.assembled) << "some discs are larger than their holes";
  Eigen::VectorXi passed = corners.passed(*path.assembled);
  std::size_t events = 0;
  for (const auto& step : path.steps) {
    for (const auto& event : step.events) passed[event.plane] += event.back ? -1 : 1;
    EXPECT_EQ(passed, corners.passed(step.c));
    events += step.events.size();
  }
  EXPECT_GE(events, 2U);
  const ContactEvent touches{joint.n_planes() + 2, CornerKind::touch, false}, opens{0, CornerKind::contact, true};
  const ContactEvent parts{joint.n_planes() + 1, CornerKind::part, false};
  EXPECT_EQ(event_text(joint, {touches, opens, parts}), "a:2 touches; a:1 loses full contact; 1 opens");
}

/// The search for loss of full contact goes as far as the increments, and finds what increments at events find.
TEST_F(ContactJoint, LoseFullContactAtTheEventsUpToTheirLargestIncrement) {
  int lost = 0, kept = 0;
  for (int i = 0; i < test::scenes(60); ++i) {
    const JointEquations equations = make_equations(random_contact_joint(random_, kind(i)));
    const LoadPath path = follow(equations, {0.2, 0.4, 0.1}, {}), events = follow_events(equations, {});
    const auto found = search_interference(equations, {}, path);
    ASSERT_EQ(found.has_value(), equations.has_interference()) << i;
    if (!found || path.failure || events.failure) continue;
    EXPECT_EQ(found->followed, 0.4) << i;
    for (Index rim = 0; rim < found->lost.size(); ++rim) {
      const ContactEvent parts{equations.n_planes() + 2 * rim + 1, CornerKind::part, false};
      double first = std::numeric_limits<double>::infinity();
      for (const auto& step : events.steps)
        if (std::ranges::find(step.events, parts) != step.events.end()) first = std::min(first, step.load_factor);
      const double at = found->lost[rim];
      if (equations.rims[rim]->contact().gap() >= 0 || at == 0) continue;
      if (first > 0.4) first = std::numeric_limits<double>::infinity();
      std::isinf(at) ? ++kept : ++lost;
      EXPECT_TRUE(at == first || std::abs(at - first) < 1e-6) << i << ": " << at << " and " << first;
    }
  }
  EXPECT_GT(lost, test::scenes(10));
  EXPECT_GT(kept, test::scenes(10));
}

}  // namespace
}  // namespace fastjoint::stage3
