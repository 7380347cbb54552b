// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/seal.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "common/errors.hpp"

namespace fastjoint::h5 {
namespace {

constexpr std::string_view mark = "\nfastjoint xxhash ", earlier_mark = "\nfastjoint digest ";
constexpr std::size_t seal_size = mark.size() + 16 + 1;

}  // namespace

std::string digest(std::string_view bytes) { return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size())); }

std::string seal(const std::string& digest) { return fmt::format("{}{}\n", mark, digest); }

std::string checked_digest(const std::string& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  std::string bytes(in.tellg(), '\0');
  in.seekg(0).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const std::string_view image = std::string_view(bytes).substr(0, bytes.size() - std::min(bytes.size(), seal_size));
  const std::string_view end = std::string_view(bytes).substr(image.size());
  if (end.starts_with(earlier_mark))
    throw FileError(
        fmt::format("{}: has the digest of an earlier version of this program, which misses some damage; "
                    "make it again, or take it unchecked by h5repack {} NEW.h5",
                    path, path));
  if (!end.starts_with(mark)) {
    // A mark that is not where it must be tells of bytes cut off or added.
    const auto last = std::string_view(bytes).substr(bytes.size() - std::min<std::size_t>(bytes.size(), 4 * seal_size));
    if (last.find("\nfastjoint") != last.npos || last.find(" xxhash ") != last.npos)
      throw FileError(fmt::format("{}: is damaged: its digest is not at its end; make it again", path));
    return {};
  }
  std::string found = digest(image);
  if (end != seal(found))
    throw FileError(fmt::format("{}: is damaged: its bytes do not match their digest; make it again", path));
  return found;
}

}  // namespace fastjoint::h5
