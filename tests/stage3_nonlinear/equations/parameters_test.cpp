// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/parameters.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/stage3_nonlinear/named_laws.hpp"

namespace fastjoint::stage3 {
namespace {

const PathOptions tight{{}, {.tolerance = 1e-13}};

/// Gives every number of a joint another value, of its size.
void change(JointModel& joint, std::mt19937& random) {
  const auto changed = [&](double& number) { number *= uniform(random, 0.7, 1.2); };
  for (auto& plate : joint.plates) {
    for (double& force : plate.external_force) changed(force);
    for (double& force : plate.traction_force) changed(force);
    for (auto& given : plate.external_displacement)
      if (given) changed(*given);
  }
  for (auto& plane : joint.planes) {
    changed(plane.clearance);
    plane.law = test::power_law(uniform(random, 100, 10000), uniform(random, 0.6, 1));
  }
  for (auto& fastener : joint.fasteners)
    for (auto& hole : fastener.holes) {
      changed(hole.gap);
      changed(hole.mu);
    }
}

/// A joint that is condensed once takes other numbers, in memory, as if it had been made with them.
void expect_same_with_other_numbers(const JointModel& joint, std::mt19937& random, const std::string& where) {
  const auto system = std::make_shared<const CondensedSystem>(condense(joint));
  for (int run = 0; run < 3; ++run) {
    JointModel other = joint;
    change(other, random);
    const LoadPath anew = follow(make_equations(other), {0.4, 1}, tight);
    const LoadPath path = follow(make_equations(joint, system, parameters_of(other)), {0.4, 1}, tight);
    ASSERT_EQ(path.failure.has_value(), anew.failure.has_value()) << where;
    ASSERT_EQ(path.steps.size(), anew.steps.size()) << where;
    for (std::size_t i = 0; i < path.steps.size(); ++i)
      EXPECT_EQ(path.steps[i].F, anew.steps[i].F) << where << " at " << path.steps[i].load_factor;
  }
}

TEST(Parameters, ChangeWhileTheCondensedJointStays) {
  std::mt19937 random(41);
  for (int i = 0; i < 3 * test::n_kinds; ++i) {
    auto joint = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(joint.equations());  // puts the laws in
    expect_same_with_other_numbers(joint.model, random, "joint " + std::to_string(i));
  }
}

TEST_F(ContactJoint, TakeOtherGapsAndFrictionWhileTheCondensedJointStays) {
  for (int i = 0; i < 24; ++i) {
    ContactKind its = kind(i);
    its.mu = i % 2 == 0 ? 0.2 : 0;
    expect_same_with_other_numbers(random_contact_joint(random_, its), random_, "joint " + std::to_string(i));
  }
}

TEST(LoadCases, OfAHoleActOnTheSideThatTheForcePointsTo) {
  const std::vector<LoadCase> cases{{0, 0, 0, false, false, 0}, {1, 0, 0, true, false, 1}, {1, 0, 1, true, false, -1}};
  const auto rates = [&](double force, double factor) { return load_rates(cases, Eigen::Vector2d(7, force), factor); };
  EXPECT_EQ(rates(5, 1), Eigen::Vector3d(7, 5, 0));
  EXPECT_EQ(rates(5, -1), Eigen::Vector3d(7, 0, 5));
  EXPECT_EQ(rates(-5, 1), Eigen::Vector3d(7, 0, -5));
  EXPECT_EQ(rates(-5, -1), Eigen::Vector3d(7, -5, 0));
}

}  // namespace
}  // namespace fastjoint::stage3
