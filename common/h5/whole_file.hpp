// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace fastjoint::h5 {

/// A file that is written atomically: a temporary file next to it, fsync, rename.
///
/// An existing file at the path is kept on every failure. The temporary file is locked while its writer runs, and
/// removed unless finished; those of killed programs are removed by the next writer. Throws FileError with the path and
/// the reason.
class WholeFile {
 public:
  explicit WholeFile(std::string path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] const std::string& unfinished_path() const { return temporary_; }
  /// Appends bytes to the temporary file.
  void append(std::string_view bytes);
  /// Renames the temporary file to the path.
  void finish();

 private:
  std::string path_, target_, temporary_;
  int file_ = -1;
  bool renamed_ = false;
};

/// Writes a WholeFile of the given bytes.
void write_whole_file(const std::string& path, std::string_view bytes);

/// Removes the temporary file that is being written, if any. Async-signal-safe.
void remove_unfinished() noexcept;

/// Removes temporary files of killed writers of a target: those that no running process has locked.
void remove_abandoned(const std::string& target);

/// Throws FileError if no file can be written at `path`, to be called before a long computation.
void check_can_write(const std::string& path);

/// True if both paths refer to the same file, which need not exist yet; false for an empty path.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

/// Digest of the first n bytes of a file, or of all if it has fewer, 16 hexadecimal digits: XXH3 of xxHash, 64 bits
/// (https://xxhash.com). Throws FileError if it cannot be opened.
[[nodiscard]] std::string digest(const std::string& path, std::size_t n = std::string::npos);

/// Line with the digest of the HDF5 bytes, appended to them. HDF5 ignores bytes after its end of file, and drops them
/// when the file is edited.
[[nodiscard]] std::string seal(const std::string& digest);

/// Digest in the seal of the file at `path`; empty for a file without a seal (hand-made or edited), which is accepted.
/// Throws FileError if the bytes do not match the seal, or if the seal is of an earlier version, whose digest misses
/// some damage. It must be called before HDF5 reads the file: flipped bits in its structures make the library crash.
/// @param name Of the file, for messages.
[[nodiscard]] std::string checked_digest(const std::string& path, const std::string& name);

}  // namespace fastjoint::h5
