// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
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

/// Removes temporary files of killed writers of a target: those that no running process has locked.
void remove_abandoned(const std::string& target) {
  const std::string start = fs::path(target).filename().string() + ".";
  std::error_code unreadable;  // an unreadable folder is left unchanged
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

/// Resolves a symbolic link, so that its target is replaced and not the link.
std::string resolved(const std::string& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored).string() : path;
}

constexpr std::string_view mark = "\nfastjoint xxhash ", earlier_mark = "\nfastjoint digest ";
constexpr std::size_t seal_size = mark.size() + 16 + 1;

std::ifstream open(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  return in;
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
  // weakly_canonical leaves a path relative if no part of it exists, hence absolute; full() is empty on failure.
  const auto full = [&](const std::string& path) { return fs::weakly_canonical(fs::absolute(path, ignored), ignored); };
  const fs::path first = full(a);
  return !first.empty() && first == full(b);
}

WholeFile::WholeFile(std::string path) : path_(std::move(path)), target_(resolved(path_)) {
  check_can_write(path_);
  remove_abandoned(target_);
  struct stat status {};
  do {  // repeated if another process has removed the file as abandoned before it was locked
    if (file_ >= 0) ::close(file_);
    unfinished = nullptr;
    temporary_ = fmt::format("{}.{:08x}{}", target_, std::random_device()(), ending);
    unfinished = temporary_.c_str();  // set before the file exists, since a signal may arrive right after
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

std::string digest(const std::string& path, std::size_t n) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  auto in = open(path);
  std::string piece(1 << 18, '\0');
  do {
    in.read(piece.data(), static_cast<std::streamsize>(std::min(n, piece.size())));
    XXH3_64bits_update(state.get(), piece.data(), in.gcount());
    n -= in.gcount();
  } while (in && n > 0);
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

std::string seal(const std::string& digest) { return fmt::format("{}{}\n", mark, digest); }

std::string checked_digest(const std::string& path) {
  auto in = open(path);
  const std::size_t size = in.seekg(0, std::ios::end).tellg();
  const std::size_t n_last = std::min(size, 4 * seal_size), n_image = size - std::min(size, seal_size);
  std::string last(n_last, '\0');
  in.seekg(-static_cast<std::streamoff>(n_last), std::ios::end).read(last.data(), static_cast<std::streamsize>(n_last));
  const std::string_view end = std::string_view(last).substr(n_last - (size - n_image));
  if (end.starts_with(earlier_mark))
    throw FileError(
        fmt::format("{}: has the digest of an earlier version of this program, which misses some damage; "
                    "make it again, or take it unchecked by h5repack {} NEW.h5",
                    path, path));
  if (!end.starts_with(mark)) {
    // A mark at another place shows that bytes were cut off or added.
    if (last.find("\nfastjoint") != last.npos || last.find(" xxhash ") != last.npos)
      throw FileError(fmt::format("{}: is damaged: its digest is not at its end; make it again", path));
    return {};
  }
  std::string found = digest(path, n_image);
  if (end != seal(found))
    throw FileError(fmt::format("{}: is damaged: its bytes do not match their digest; make it again", path));
  return found;
}

}  // namespace fastjoint::h5
