// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace fastjoint::h5 {

/// Line that follows the HDF5 bytes of our files and holds their digest (64-bit FNV-1a over 8-byte words). HDF5 ignores
/// what stands behind its end of file, and drops it when somebody edits the file.
[[nodiscard]] std::string seal(std::string_view image);

/// Throws FileError if the file at `path` has a seal that its bytes do not match. This must come before HDF5 reads it:
/// flipped bits in its own structures make the library crash. A file without a seal (hand-made, edited) is taken as it
/// is.
void check_seal(const std::string& path);

}  // namespace fastjoint::h5
