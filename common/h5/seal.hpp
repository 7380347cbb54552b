// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::h5 {

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
