// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fastjoint::h5 {

/// 64-bit FNV-1a over 8-byte words (the last one padded with zeros), as 16 hexadecimal digits.
/// Stored with every dataset: a flipped bit is found when the dataset is read.
[[nodiscard]] std::string digest(const void* data, std::size_t n_bytes);

/// Digest of strings, each ended by a zero byte.
[[nodiscard]] std::string digest(const std::vector<std::string>& strings);

}  // namespace fastjoint::h5
