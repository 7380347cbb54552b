// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/seal.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include "common/errors.hpp"

namespace fastjoint::h5 {
namespace {

constexpr std::string_view mark = "\nfastjoint xxhash ", earlier_mark = "\nfastjoint digest ";
constexpr std::size_t seal_size = mark.size() + 16 + 1;

std::ifstream open(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  return in;
}

}  // namespace

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
    // A mark that is not where it must be tells of bytes cut off or added.
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
