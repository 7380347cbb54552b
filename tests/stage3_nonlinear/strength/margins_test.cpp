// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/margins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fastjoint::stage3 {
namespace {

using ::testing::HasSubstr;

/// An increment whose applied stress is not known does not count, and a warning says of which holes: the margin of the
/// others may be too high.
TEST(Margins, SayWhichLackIncrements) {
  JointScene scene;
  CheckScene check;
  check.name = "net";
  formats::JointResult result;
  result.load_factor = Eigen::Vector2d(0.5, 1);
  result.case_of = Eigen::Vector2i(0, 0);
  result.case_name = {""};
  const auto item = [&](const char* of, double first, double second) {
    return CheckedItem{&check, of, "F_tu", "MPa", [=](const JointColumns&, Index step) {
                         return Applied{.applied = step == 0 ? first : second, .allowable = 100};
                       }};
  };
  LeftOut missing;
  const auto found = margins({item("known", 20, 50), item("partly", 20, infinite), item("unknown", infinite, infinite)},
                             result, missing);
  const auto left_out = missing.warnings(scene);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].of, "known");
  EXPECT_EQ(found[0].margin, 1);
  EXPECT_EQ(found[0].at, 1);
  EXPECT_EQ(found[1].margin, 4);
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_THAT(left_out[0].text, HasSubstr("check \"net\" is not made for unknown: its value is not known"));
  EXPECT_THAT(left_out[1].text,
              HasSubstr("check \"net\" is made of some increments alone for partly: its value is not known"));
}

}  // namespace
}  // namespace fastjoint::stage3
