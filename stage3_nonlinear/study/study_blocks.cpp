// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"

namespace fastjoint::stage3 {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& output) { return output + ".parts"; }

/// A sixty-fourth of all samples, so that the loss of a block costs little, within limits for fast writing and reading.
int block_size(std::uint64_t n_samples) {
  constexpr std::uint64_t parts = 64, min_size = 16, max_size = 8192;
  return int(std::clamp((n_samples + parts - 1) / parts, min_size, max_size));
}

formats::StudyBlock read_block(const std::string& path) {
  try {
    return formats::read_study_block(path);
  } catch (const FileError& e) {
    // A run removes the blocks after it has written the study.
    throw FileError(fmt::format("{}; {}", e.what(),
                                fs::exists(path)
                                    ? "remove this block, and its samples are solved again"
                                    : "another run may have made the same study meanwhile, and removed it"));
  }
}

}  // namespace

StudyBlocks::StudyBlocks(const std::string& output, formats::StudyOrigin origin, std::uint64_t n_samples,
                         Eigen::Index n_columns)
    : folder_(folder_of(output)),
      origin_(std::move(origin)),
      n_samples_(n_samples),
      size_(block_size(n_samples)),
      n_blocks_(int((n_samples + size_ - 1) / size_)),
      n_columns_(n_columns) {}

std::optional<std::uint64_t> StudyBlocks::seed_in(const std::string& output) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder_of(output), none)) {
    if (entry.path().extension() != ".h5") continue;
    const std::string path = entry.path().string(), seed = read_block(path).origin.seed;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(seed.data(), seed.data() + seed.size(), value);
    if (error != std::errc() || end != seed.data() + seed.size())
      throw FileError(fmt::format("{}: attribute 'seed' is \"{}\", expected a whole number", path, seed));
    return value;
  }
  return std::nullopt;
}

std::string StudyBlocks::path(int block) const { return fmt::format("{}/block-{:06}.h5", folder_, block); }

std::pair<int, int> StudyBlocks::of_slice(int slice, int n) const {
  const auto bound = [&](std::int64_t i) { return int(i * n_blocks_ / n); };
  return {bound(slice - 1), bound(slice)};
}

void StudyBlocks::check_origin(const formats::StudyBlock& found, const std::string& path) const {
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        fmt::format("{}: its samples are of {}; allowed: blocks of this study, or none (remove {}, or take "
                    "another -o)",
                    path, what, folder_));
  };
  const auto& its = found.origin;
  if (its.joint != origin_.joint) refuse("another joint");
  if (its.study != origin_.study) refuse("another study");
  if (its.seed != origin_.seed) refuse(fmt::format("another seed ({}, not {})", its.seed, origin_.seed));
  if (its.generator != origin_.generator) refuse(fmt::format("another version, {}", its.generator));
  for (std::size_t i = 0; i < origin_.file.size(); ++i)
    if (i >= its.file.size() || its.file[i] != origin_.file[i] || its.digest[i] != origin_.digest[i])
      refuse(fmt::format("another {}", origin_.file[i]));
}

void StudyBlocks::check() const {
  for (int block = 0; block < n_blocks_; ++block)
    if (has(block)) return;
}

bool StudyBlocks::has(int block) const {
  if (!fs::exists(path(block))) return false;
  (void)read(block);
  return true;
}

formats::StudyBlock StudyBlocks::read(int block) const {
  const std::string at = path(block);
  auto found = read_block(at);
  check_origin(found, at);
  if (found.number != block || found.size != size_ || found.status.size() != Eigen::Index(end(block) - first(block)) ||
      found.values.cols() != n_columns_)
    throw FileError(fmt::format("{}: does not hold block {} of this study", at, block));
  return found;
}

void StudyBlocks::write(int block, Eigen::VectorXi status, formats::StudyRows values) const {
  std::error_code failed;
  fs::create_directories(folder_, failed);
  if (failed) throw FileError(fmt::format("{}: cannot be made: {}", folder_, failed.message()));
  formats::write(path(block), {origin_, block, size_, std::move(status), std::move(values)});
}

std::string StudyBlocks::missing() const {
  std::string list;
  for (int block = 0; block < n_blocks_; ++block) {
    if (fs::exists(path(block))) continue;
    int last = block;
    while (last + 1 < n_blocks_ && !fs::exists(path(last + 1))) ++last;
    list += fmt::format("{}{} to {}", list.empty() ? "" : ", ", first(block), end(last) - 1);
    block = last;
  }
  return list;
}

void StudyBlocks::remove() const {
  std::error_code ignored;
  for (int block = 0; block < n_blocks_; ++block) fs::remove(path(block), ignored);
  if (fs::remove(folder_, ignored)) return;
  for (int block = 0; block < n_blocks_; ++block) h5::remove_abandoned(path(block));
  fs::remove(folder_, ignored);
}

}  // namespace fastjoint::stage3
