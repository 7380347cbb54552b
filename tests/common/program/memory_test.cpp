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

/// The same of version 1, whose first numbers of memory.stat leave out what the groups below take.
TEST(ControlGroup, OfTheFirstVersionIsReadToo) {
  const test::TemporaryFolder folder;
  folder.write("memory.limit_in_bytes", "1000000000\n");
  folder.write("memory.usage_in_bytes", "950000000\n");
  folder.write("memory.stat",
               "cache 5\nrss 7\ninactive_file 11\nactive_file 13\nhierarchical_memory_limit 1000000000\n"
               "total_cache 800000000\ntotal_inactive_file 600000000\ntotal_active_file 200000000\n");
  EXPECT_EQ(left_in_control_group(folder.path("")), 850e6);
  folder.write("memory.limit_in_bytes", "9223372036854771712\n");  // says that there is none
  EXPECT_GT(left_in_control_group(folder.path("")), 1e18);
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

TEST(PeakMemory, GrowsWithWhatIsUsedAndNeverFalls) {
  const double before = peak_memory();
  EXPECT_GT(before, 1e6) << "a program with libraries";
  constexpr double more = 2e8;
  const double used = [&] {
    const std::string memory(static_cast<std::size_t>(before + more), 'x');
    return memory.back() == 'x' ? peak_memory() : 0.0;
  }();
  EXPECT_GT(used, before + 0.9 * more);
  EXPECT_LT(used, 2 * before + 1.1 * more);
  EXPECT_GE(peak_memory(), 0.99 * used) << "the memory was given back";
}

}  // namespace
}  // namespace fastjoint::program
