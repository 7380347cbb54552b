// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace fastjoint::test {

/// A folder of its own for one test, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Path of a file in the folder.
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes `text` to a file in the folder and returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
};

[[nodiscard]] std::string read_file(const std::string& path);

/// Path of one of the three programs, which are built into the folder of the test's own.
[[nodiscard]] std::string program(const std::string& name);

/// What a program printed and how it ended.
struct Run {
  int status;
  std::string out, err;
};

/// Runs a shell command line with stdout and stderr caught in `folder`.
[[nodiscard]] Run run(const TemporaryFolder& folder, const std::string& command_line);

}  // namespace fastjoint::test
