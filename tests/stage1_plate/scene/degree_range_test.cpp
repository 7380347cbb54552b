// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/scene.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"

namespace fastjoint::stage1 {
namespace {

TEST(DegreeRange, OneDegreeOrARange) {
  PlateScene scene;
  set_degrees(scene, "");
  EXPECT_EQ(std::pair(scene.p_low, scene.p_high), std::pair(1, 8));
  set_degrees(scene, "5");
  EXPECT_EQ(std::pair(scene.p_low, scene.p_high), std::pair(5, 5));
  set_degrees(scene, "2..7");
  EXPECT_EQ(std::pair(scene.p_low, scene.p_high), std::pair(2, 7));
}

TEST(DegreeRange, RefusesAnythingElse) {
  PlateScene scene;
  for (const char* wrong : {"0", "9", "4..2", "x", "1..", "..3", "1..9", "2.5", "1...3", "-1", " 3"})
    EXPECT_THAT(
        [&] { set_degrees(scene, wrong); },
        testing::ThrowsMessage<InputError>(testing::HasSubstr("--p: '" + std::string(wrong) + "' is not allowed")));
}

}  // namespace
}  // namespace fastjoint::stage1
