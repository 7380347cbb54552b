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

/// A temporary file beside a target, removed unless it was renamed. It is locked as long as its writer lives.
struct Temporary {
  std::string path;
  int file = -1;
  bool renamed = false;

  explicit Temporary(const std::string& target) {
    struct stat status {};
    do {  // again if another process has taken it for one left behind before it was locked
      if (file >= 0) ::close(file);
      unfinished = nullptr;
      path = fmt::format("{}.{:08x}{}", target, std::random_device()(), ending);
      unfinished = path.c_str();  // before it exists: a signal may come as soon as it does
      file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file < 0) {
        unfinished = nullptr;
        fail(target, errno);
      }
    } while (::flock(file, LOCK_EX) == 0 && ::fstat(file, &status) == 0 && status.st_nlink == 0);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    unfinished = nullptr;
    if (!renamed) ::unlink(path.c_str());
    ::close(file);
  }
};

void write_all(int fd, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, errno);
    bytes.remove_prefix(written);
  }
}

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

void write_whole_file(const std::string& path, std::string_view bytes) {
  check_can_write(path);
  const std::string target = resolved(path);
  remove_left_behind(target);
  Temporary temporary(target);
  write_all(temporary.file, bytes, path);
  if (::fsync(temporary.file) != 0) fail(path, errno);
  if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail(path, errno);
  temporary.renamed = true;
  const int folder = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void remove_unfinished() noexcept {
  if (const char* path = unfinished) ::unlink(path);
}

}  // namespace fastjoint::h5
