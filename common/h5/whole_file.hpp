// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace fastjoint::h5 {

/// A file that appears at its path whole or not at all: a temporary file beside it, fsync, rename.
///
/// Removes those that killed programs have left beside it. What was at the path before survives every failure. The
/// temporary file is locked as long as its writer lives, and removed unless it was finished. Throws FileError with the
/// path and the reason.
class WholeFile {
 public:
  explicit WholeFile(std::string path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] const std::string& unfinished_path() const { return temporary_; }
  /// Adds bytes at the end of the temporary file.
  void append(std::string_view bytes);
  /// Puts the file at its path.
  void finish();

 private:
  std::string path_, target_, temporary_;
  int file_ = -1;
  bool renamed_ = false;
};

/// A WholeFile of given bytes.
void write_whole_file(const std::string& path, std::string_view bytes);

/// Removes the temporary file that is being written, if there is one; a handler of signals may call this.
void remove_unfinished() noexcept;

/// Throws FileError unless a file could be put at `path`: asked before the work, not after it.
void check_can_write(const std::string& path);

/// True if both paths lead to one file, which need not exist yet; an empty path leads to none.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

/// Digest of the first n bytes of a file, or of all if it has fewer, 16 hexadecimal digits: XXH3 of xxHash, 64 bits
/// (https://xxhash.com). Throws FileError if it cannot be opened.
[[nodiscard]] std::string digest(const std::string& path, std::size_t n = std::string::npos);

/// Line that follows the HDF5 bytes of our files and holds their digest. HDF5 ignores what stands behind its end of
/// file, and drops it when somebody edits the file.
[[nodiscard]] std::string seal(const std::string& digest);

/// Digest in the seal of the file at `path`; empty for a file without a seal (hand-made, edited), which is taken as it
/// is. Throws FileError if the bytes do not match the seal, or if the seal is that of an earlier version, whose digest
/// misses damage. This must come before HDF5 reads the file: flipped bits in its own structures make the library crash.
[[nodiscard]] std::string checked_digest(const std::string& path);

}  // namespace fastjoint::h5
