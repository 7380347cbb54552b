// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/fastener_gaps.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A clearance c of a law lets the sheets move by c; a gap does so in each hole.
TEST(FastenerGaps, SaysTheGapThatMeansTheSameAsAClearanceInContact) {
  constexpr double radius = 2.5;
  const auto said = [&](bool a_in_contact, bool b_in_contact, const std::string& between,
                        const std::string& clearance) {
    auto lap = test::two_fastener_lap();
    if (a_in_contact) test::add_contact(lap.a, "1", radius);
    if (b_in_contact) test::add_contact(lap.b, "1", radius);
    const test::TemporaryFolder folder;
    try {
      const std::string path = test::write_joint(
          folder, lap,
          {{"plates", R"({"a": "a.h5", "b": "b.h5", "c": "b.h5"})"},
           {"fasteners", R"([{"id": "f", "between": [)" + between + R"(], "law": "lin", "clearance": )" + clearance +
                             R"(}, {"id": "g", "between": ["b:2", "a:2", "c:2"], "law": "lin"}])"}});
      (void)load_joint(read_joint_scene(input::parse(path, test::read_file(path))), 0);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string lap = R"("a:1", "b:1")", stack = R"("b:1", "a:1", "c:1")", held = R"("a:1", "ground")";
  EXPECT_EQ(said(true, true, lap, "0"), "");
  EXPECT_EQ(said(false, false, lap, "0.06"), "");
  EXPECT_THAT(said(true, true, lap, "0.06"),
              AllOf(HasSubstr("joint.json: /fasteners/0/clearance: 0.06 "),
                    HasSubstr("hole \"a:1\" has compression-only springs"), HasSubstr("write \"gap\": 0.03 instead")));
  EXPECT_THAT(said(true, false, lap, "0.06"), HasSubstr("write \"gap\": [0.06, 0] instead"));
  EXPECT_THAT(said(false, true, lap, "0.06"), HasSubstr("write \"gap\": [0, 0.06] instead"));
  EXPECT_THAT(said(true, false, held, "0.06"), HasSubstr("write \"gap\": 0.06 instead"));
  EXPECT_THAT(said(true, true, stack, "0.06"), HasSubstr("write \"gap\": 0.03 instead"));
  EXPECT_THAT(said(true, false, stack, "0.06"), HasSubstr("write \"gap\": [0, 0.06, 0] instead"));
  EXPECT_THAT(said(false, true, stack, "[0.06, 0.02]"), HasSubstr("write \"gap\": [0.06, 0, 0.02] instead"));
  EXPECT_THAT(said(true, false, stack, "[0.06, 0.02]"),
              HasSubstr("add up to the clearance in the two holes of each shear plane"));
}

TEST(FastenerGaps, GapsEqualToClearancesAreNeverNegative) {
  using testing::DoubleNear;
  using testing::Pointwise;
  const auto equal = [](const std::vector<double>& clearance, const std::vector<bool>& in_contact) {
    return equal_gaps(clearance, in_contact);
  };
  EXPECT_THAT(equal({0.1, 0.2}, {true, true, true}), Pointwise(testing::DoubleEq(), {0.05, 0.05, 0.15}));
  EXPECT_THAT(equal({0.1, 0.2, 0.3}, {true, true, true, false}), testing::IsEmpty()) << "0.3, then -0.1";
  EXPECT_THAT(equal({0.2, 0.3, 0.2}, {true, true, true}), Pointwise(DoubleNear(1e-15), {0.1, 0.1, 0.2})) << "grounded";
}

}  // namespace
}  // namespace fastjoint::stage3
