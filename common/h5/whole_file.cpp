// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>

#include "common/errors.hpp"

namespace fastjoint::h5 {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const std::string& path, int reason) {
  throw FileError(fmt::format("{}: cannot be written: {}", path, std::strerror(reason)));
}

constexpr std::string_view ending = ".partial";

/// Path of the temporary file that is being written, or null.
std::atomic<const char*> unfinished = nullptr;

std::string folder_of(const std::string& path) {
  const auto parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

/// Removes what killed writers of a target have left: temporary files that no living one has locked.
void remove_left_behind(const std::string& target) {
  const std::string start = fs::path(target).filename().string() + ".";
  std::error_code unreadable;  // then what is there stays
  for (const auto& entry : fs::directory_iterator(folder_of(target), unreadable)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(ending) ||
        name.find_first_not_of("0123456789abcdef", start.size()) != name.size() - ending.size())
      continue;
    const int file = ::open(entry.path().c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
    ::close(file);
  }
}

/// A symbolic link stays one: its target is what gets replaced.
std::string resolved(const std::string& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored).string() : path;
}

}  // namespace

void check_can_write(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw FileError(fmt::format("{}: cannot be written: it is not a regular file", path));
  if (::access(folder_of(resolved(path)).c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

bool same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  // A relative path of which nothing exists yet would stay relative; where no path can be, full() is empty.
  const auto full = [&](const std::string& path) { return fs::weakly_canonical(fs::absolute(path, ignored), ignored); };
  const fs::path first = full(a);
  return !first.empty() && first == full(b);
}

WholeFile::WholeFile(std::string path) : path_(std::move(path)), target_(resolved(path_)) {
  check_can_write(path_);
  remove_left_behind(target_);
  struct stat status {};
  do {  // again if another process has taken it for one left behind before it was locked
    if (file_ >= 0) ::close(file_);
    unfinished = nullptr;
    temporary_ = fmt::format("{}.{:08x}{}", target_, std::random_device()(), ending);
    unfinished = temporary_.c_str();  // before it exists: a signal may come as soon as it does
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (file_ < 0) {
      unfinished = nullptr;
      fail(path_, errno);
    }
  } while (::flock(file_, LOCK_EX) == 0 && ::fstat(file_, &status) == 0 && status.st_nlink == 0);
}

WholeFile::~WholeFile() {
  unfinished = nullptr;
  if (!renamed_) ::unlink(temporary_.c_str());
  ::close(file_);
}

void WholeFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, errno);
    bytes.remove_prefix(written);
  }
}

void WholeFile::finish() {
  if (::fsync(file_) != 0) fail(path_, errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, errno);
  renamed_ = true;
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void write_whole_file(const std::string& path, std::string_view bytes) {
  WholeFile file(path);
  file.append(bytes);
  file.finish();
}

void remove_unfinished() noexcept {
  if (const char* path = unfinished) ::unlink(path);
}

}  // namespace fastjoint::h5
