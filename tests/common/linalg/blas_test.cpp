// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/processor.hpp"

#include <gtest/gtest.h>

namespace fastjoint::linalg {
namespace {

TEST(BlasKernels, AreBetterWhereTheProcessorIsUnknownToOpenBlas) {
  EXPECT_EQ(better_kernels("Prescott", true, true), "SkylakeX");
  EXPECT_EQ(better_kernels("Prescott", true, false), "Haswell");
  EXPECT_EQ(better_kernels("Prescott", false, false), "") << "an old processor has no others";
  for (const char* known : {"Haswell", "Zen", "SkylakeX", "Cooperlake", "Nehalem", ""})
    EXPECT_EQ(better_kernels(known, true, true), "") << known;
}

}  // namespace
}  // namespace fastjoint::linalg
