// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace fastjoint::h5 {

std::string digest(const void* data, std::size_t n_bytes) {
  constexpr std::uint64_t offset_basis = 14695981039346656037U;
  constexpr std::uint64_t prime = 1099511628211U;
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t hash = offset_basis;
  for (std::size_t i = 0; i < n_bytes; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof word, n_bytes - i));
    hash = (hash ^ word) * prime;
  }
  return fmt::format("{:016x}", hash ^ n_bytes);
}

std::string digest(const std::vector<std::string>& strings) {
  std::string joined;
  for (const auto& s : strings) joined.append(s).push_back('\0');
  return digest(joined.data(), joined.size());
}

}  // namespace fastjoint::h5
