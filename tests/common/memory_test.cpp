// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/memory.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "common/errors.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::program {
namespace {

/// Files by which the kernel shows a container of 1 GB, 950 MB of it taken, 800 MB of these by copies of files.
TEST(ControlGroup, CopiesOfFilesAreNotUsedMemory) {
  const test::TemporaryFolder folder;
  folder.write("memory.max", "1000000000\n");
  folder.write("memory.current", "950000000\n");
  folder.write("memory.stat",
               "anon 150000000\nfile 800000000\ninactive_anon 5\nactive_anon 7\n"
               "inactive_file 600000000\nactive_file 200000000\n");
  EXPECT_EQ(left_in_control_group(folder.path("")), 850e6);
}

TEST(ControlGroup, WithoutLimitNoneIsFound) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(left_in_control_group(folder.path("none/")) < 1e300);
  folder.write("memory.max", "max\n");
  folder.write("memory.current", "950000000\n");
  EXPECT_FALSE(left_in_control_group(folder.path("")) < 1e300);
}

TEST(RequireMemory, NamesTheNumbers) {
  require_memory("x.h5: this", 1e6, "", "less");
  EXPECT_THAT([] { require_memory("x.h5: this", 1e18, " (all of it)", "less"); },
              testing::ThrowsMessage<InputError>(
                  testing::AllOf(testing::StartsWith("x.h5: this takes about 1000000000.0 GB of memory (all of it), "),
                                 testing::EndsWith("B are available; allowed: less"))));
}

}  // namespace
}  // namespace fastjoint::program
