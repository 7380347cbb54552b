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
#include <optional>
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

/// Resolves a symbolic link, so that its target is replaced and not the link.
/// A dangling one has a target too.
std::string resolved(const std::string& path) {
  std::error_code ignored;
  fs::path target = path;
  constexpr int most_links = 40;  // that of Linux
  for (int i = 0; i < most_links && fs::is_symlink(target, ignored); ++i) {
    const fs::path next = fs::read_symlink(target, ignored);
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target.string();
}

constexpr std::string_view mark = "\nfastjoint xxhash ", earlier_mark = "\nfastjoint digest ";
constexpr std::size_t seal_size = mark.size() + 16 + 1;

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Returns where an HDF5 file says that it ends, by its superblock (HDF5 file format specification, section II.A);
/// nullopt for other files. @param start First bytes of the file.
std::optional<std::uint64_t> end_of_image(std::string_view start) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  constexpr std::size_t width = 8, version_at = 8;
  if (!start.starts_with(signature) || start.size() < 64) return std::nullopt;
  const int version = static_cast<unsigned char>(start[version_at]);
  const bool is_early = version == 0 || version == 1;
  if (!is_early && version != 2 && version != 3) return std::nullopt;
  if (start[is_early ? 13 : 9] != char(width)) return std::nullopt;  // addresses of another size
  return little_endian(start.substr(version == 0 ? 40 : version == 1 ? 44 : 28, width));
}

std::ifstream open(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  return in;
}

}  // namespace

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

void check_can_write(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw FileError(fmt::format("{}: cannot be written: it is not a regular file", path));
  const auto mode = fs::status(path, ignored).permissions();  // the system lets root write to read-only files
  if (fs::exists(path, ignored) &&
      ((mode & fs::perms::owner_write) == fs::perms::none || ::access(path.c_str(), W_OK) != 0))
    throw FileError(
        fmt::format("{}: cannot be written: it is read-only; make it writable, or choose another name", path));
  if (fs::is_symlink(resolved(path), ignored)) fail(path, ELOOP);
  const std::string folder = folder_of(resolved(path)), name = fs::path(resolved(path)).filename().string();
  constexpr std::size_t added = 1 + 8 + ending.size();  // by the name of the temporary file
  if (const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
      longest > 0 && name.size() + added > std::size_t(longest))
    fail(path, ENAMETOOLONG);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

bool same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  // weakly_canonical leaves a path relative if no part of it exists, hence absolute; full() is empty on failure.
  const auto full = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(resolved(path), ignored), ignored);
  };
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

std::string checked_digest(const std::string& path, const std::string& name) {
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
                    name, name));
  if (!end.starts_with(mark)) {
    // A mark at another place shows that bytes were cut off or added.
    if (last.find("\nfastjoint") != last.npos || last.find(" xxhash ") != last.npos)
      throw FileError(fmt::format("{}: is damaged: its digest is not at its end; make it again", name));
    std::string start(std::min<std::size_t>(size, 64), '\0');
    in.seekg(0).read(start.data(), static_cast<std::streamsize>(start.size()));
    // HDF5 cuts off what is beyond its end when it edits a file, so that such bytes were a digest.
    if (const auto image = end_of_image(start); image && *image < size)
      throw FileError(
          fmt::format("{}: is damaged: the {} bytes after the end of its HDF5 data are not their digest; "
                      "make it again",
                      name, size - *image));
    return {};
  }
  std::string found = digest(path, n_image);
  if (end != seal(found))
    throw FileError(fmt::format("{}: is damaged: its bytes do not match their digest; make it again", name));
  return found;
}

}  // namespace fastjoint::h5
