// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/whole_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "common/errors.hpp"
#include "tests/common/h5/sample.hpp"

/// HDF5 forgets what it has gathered to write when closing a file fails. This hides no other leak: whatever else HDF5
/// still holds at the end it frees itself.
extern "C" const char* __lsan_default_suppressions() { return "leak:H5FL__malloc\n"; }

namespace fastjoint::h5 {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

int n_files(const test::TemporaryFolder& folder) {
  const auto at = std::filesystem::path(folder.path("x")).parent_path();
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(at), {}));
}

TEST(WholeFile, ReplacesWhatWasThereAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  write_whole_file(folder.path("a"), "first");
  write_whole_file(folder.path("a"), "second");
  EXPECT_EQ(test::read_file(folder.path("a")), "second");
  EXPECT_EQ(n_files(folder), 1);
}

/// A limit on the size of files while it lives, which fails a write as a full disk would.
class FullDisk {
 public:
  explicit FullDisk(rlim_t size) {
    getrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

 private:
  rlimit before_{};
};

TEST(WholeFile, AFailedWriteKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  write_whole_file(folder.path("a"), "old");
  {
    const FullDisk disk(1000);
    EXPECT_THAT([&] { write_whole_file(folder.path("a"), std::string(100000, 'x')); },
                ThrowsMessage<FileError>(HasSubstr("cannot be written: File too large")));
  }
  EXPECT_EQ(test::read_file(folder.path("a")), "old");
  EXPECT_EQ(n_files(folder), 1);
}

/// Wherever HDF5 finds the disk full: among its own structures, in numbers, at the end, or at the seal behind it.
TEST(WholeFile, AnHdf5FileThatFailsAnywhereKeepsTheOldFile) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a"));
  const std::string old = test::read_file(folder.path("a"));
  for (rlim_t size = 0; size < old.size(); size += size + 997 < old.size() ? 997 : 97) {
    {
      const FullDisk disk(size);
      EXPECT_THAT([&] { write_sample(folder.path("a"), 3); },
                  ThrowsMessage<FileError>(testing::MatchesRegex(".*/a: .*cannot be written: File too large")));
    }
    ASSERT_EQ(test::read_file(folder.path("a")), old) << size;
    ASSERT_EQ(n_files(folder), 1) << size;
  }
  write_sample(folder.path("a"), 3);
  EXPECT_NE(test::read_file(folder.path("a")), old);
}

/// What killed programs leave, by their number or a random one, and what only looks like it.
TEST(WholeFile, RemovesWhatKilledWritersOfTheSameFileHaveLeft) {
  const test::TemporaryFolder folder;
  const std::string own = "a." + std::to_string(getpid()) + ".partial";
  for (const std::string& stale : {own, std::string("a.7.partial"), std::string("a.0123cdef.partial")})
    folder.write(stale, "half");
  for (const char* other : {"b.7.partial", "a.h5.7.partial", "a.partial", "a.7.partial.h5"}) folder.write(other, "");
  write_whole_file(folder.path("a"), "whole");
  EXPECT_EQ(test::read_file(folder.path("a")), "whole");
  EXPECT_EQ(n_files(folder), 5) << "the file and those of other names";
}

TEST(WholeFile, LeavesTheTemporaryFileOfALivingWriter) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.0123cdef.partial", "half");
  const int living = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(flock(living, LOCK_EX | LOCK_NB), 0);
  write_whole_file(folder.path("a"), "whole");
  EXPECT_EQ(n_files(folder), 2);
  close(living);
  write_whole_file(folder.path("a"), "whole again");
  EXPECT_EQ(n_files(folder), 1);
}

TEST(WholeFile, KeepsTheModeThatTheUserWants) {
  const test::TemporaryFolder folder;
  const mode_t before = umask(0027);
  write_whole_file(folder.path("a"), "x");
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat(folder.path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(WholeFile, RefusesWhatIsNoFile) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { check_can_write(folder.path("none/a")); },
              ThrowsMessage<FileError>(HasSubstr("No such file or directory")));
  EXPECT_THAT([&] { check_can_write(folder.path(".")); }, ThrowsMessage<FileError>(HasSubstr("not a regular file")));
  ASSERT_EQ(mkfifo(folder.path("fifo").c_str(), 0600), 0);
  EXPECT_THAT([&] { check_can_write(folder.path("fifo")); }, ThrowsMessage<FileError>(HasSubstr("not a regular file")));
}

TEST(WholeFile, OneFileHasManyNames) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  std::filesystem::create_symlink(file, folder.path("link"));
  EXPECT_TRUE(same_file(file, folder.path("link")));
  EXPECT_TRUE(same_file(file, folder.path(".") + "/file"));
  EXPECT_FALSE(same_file(file, folder.path("other")));
  EXPECT_TRUE(same_file(folder.path("new"), folder.path(".") + "/new")) << "neither is there yet";
  EXPECT_TRUE(same_file("no such file", "./no such file"));
  EXPECT_FALSE(same_file("no such file", "nor this"));
  EXPECT_FALSE(same_file("", ""));
  const std::string too_long(1000, 'x');
  EXPECT_FALSE(same_file(too_long, too_long + "y"));
}

TEST(WholeFile, ASymbolicLinkStaysOne) {
  const test::TemporaryFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink(folder.path("target"), folder.path("link"));
  write_whole_file(folder.path("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link")));
  EXPECT_EQ(test::read_file(folder.path("target")), "new");
}

}  // namespace
}  // namespace fastjoint::h5
