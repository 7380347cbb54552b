// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/warning.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Warnings of a joint of two plates, whose hole "1" of the first is in a state.
std::vector<program::Warning> warnings_of(const HoleState& rim) {
  test::HandMade joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1000));
  joint.plates[0].stresses.rim_hole = {"1"};
  JointState state;
  state.plates.resize(2);
  state.plates[0].rims = {rim};
  return rim_warnings(joint, joint.numbers(), {state});
}

HoleState low_peak() {
  HoleState rim;
  rim.in_tension = true;
  rim.peak_hoop = 80;
  rim.net_concentration = 0.8;
  rim.pull = 5;
  return rim;
}

TEST(RimWarnings, DoubtAPeakBelowTheNetStressWhereSpringsPull) {
  EXPECT_THAT(warnings_of(low_peak()),
              testing::Contains(test::is_warning("kt-below-one", "joint.json: Kt net is 0.8 ")));
  HoleState none_pulls = low_peak(), open = low_peak(), compressed = low_peak(), high = low_peak();
  none_pulls.pull = 0;
  open.net_concentration = 0;
  compressed.in_tension = false;
  high.net_concentration = 1.2;
  for (const HoleState& rim : {none_pulls, open, compressed, high})
    for (const auto& each : warnings_of(rim)) EXPECT_NE(each.code, "kt-below-one") << each.text;
}

TEST(RimWarnings, DoubtFrictionAgainstTheSlipItMakes) {
  HoleState rim, small, unloaded;
  rim.against_slip = 25;
  rim.bearing_stress = 100;
  EXPECT_THAT(warnings_of(rim),
              testing::Contains(test::is_warning("friction-against-slip",
                                                 "joint.json: friction acts against the slip that it makes "
                                                 "on 25 degrees of the contact at hole ")));
  small = unloaded = rim;
  small.against_slip = 15;
  unloaded.bearing_stress = 1e-120;
  for (const HoleState& other : {small, unloaded})
    for (const auto& each : warnings_of(other)) EXPECT_NE(each.code, "friction-against-slip") << each.text;
}

class Failures : public ContactJoint {
 protected:
  /// What is said of an end at an entry: a plane, or behind the planes a rim.
  [[nodiscard]] std::string message(Index entry) {
    const test::HandMade joint = random_contact_joint(random_, {3, 2, false, 1});
    LoadPath path{.n_increments = 4, .steps = {}, .failure = {}};
    path.failure = PathFailure{1, 0.5, 0.25, entry, 1e-3, {}, {}};
    path.failure->ending = text_of(Ending::no_progress);
    JointScene scene;
    scene.file = "joint.json";
    return failure_message(scene, CaseScene{}, joint, path, "joint.h5");
  }
};

TEST_F(Failures, NameThePlaneOrTheRimThatIsWorst) {
  EXPECT_THAT(message(1), HasSubstr("worst residual 1.00e-03 of the load, at fastener \"2\""));
  EXPECT_THAT(message(3), HasSubstr("at the rim of hole \"a:1\"; the last try ended: no step lowers the residual. "));
  EXPECT_THAT(message(3 + 4), HasSubstr("at the rim of hole \"b:2\""));
}

}  // namespace
}  // namespace fastjoint::stage3
