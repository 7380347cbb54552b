// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/seal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/errors.hpp"

namespace fastjoint::h5 {
namespace {

constexpr std::string_view mark = "\nfastjoint digest ";
constexpr std::size_t seal_size = mark.size() + 16 + 1;

std::uint64_t digest(std::string_view bytes) {
  constexpr std::uint64_t offset_basis = 14695981039346656037U;
  constexpr std::uint64_t prime = 1099511628211U;
  std::uint64_t hash = offset_basis;
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    hash = (hash ^ word) * prime;
  }
  return hash ^ bytes.size();
}

}  // namespace

std::string seal(std::string_view image) { return fmt::format("{}{:016x}\n", mark, digest(image)); }

void check_seal(const std::string& path) {
  std::ostringstream text;
  const std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  text << in.rdbuf();
  const std::string_view bytes = text.view();
  if (bytes.size() < seal_size || bytes.substr(bytes.size() - seal_size, mark.size()) != mark) return;
  const std::string_view image = bytes.substr(0, bytes.size() - seal_size);
  if (bytes.substr(image.size()) != seal(image))
    throw FileError(fmt::format("{}: is damaged: its bytes do not match their digest; make it again", path));
}

}  // namespace fastjoint::h5
