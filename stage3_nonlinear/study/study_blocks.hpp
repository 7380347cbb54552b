// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/formats/study.hpp"

namespace fastjoint::stage3 {

/// The samples of a study in blocks, each a file in the folder STUDY.h5.parts that is written whole or not at all.
class StudyBlocks {
 public:
  /// @param output Path of STUDY.h5. @param n_columns How many numbers each sample has.
  StudyBlocks(const std::string& output, formats::StudyOrigin origin, std::uint64_t n_samples, Eigen::Index n_columns);

  /// Seed of the existing blocks, if there are any.
  [[nodiscard]] static std::optional<std::uint64_t> seed_in(const std::string& output);

  [[nodiscard]] int n_blocks() const { return n_blocks_; }
  [[nodiscard]] std::uint64_t first(int block) const { return std::uint64_t(block) * size_; }
  [[nodiscard]] std::uint64_t end(int block) const { return std::min(first(block + 1), n_samples_); }
  /// First block and end of a slice of n, which is 1-based.
  [[nodiscard]] std::pair<int, int> of_slice(int slice, int n) const;
  /// Throws InputError if an existing block is of another study, before work that could not be merged with it.
  void check() const;
  /// True if a block exists. Throws InputError if it is of another study, FileError if it is damaged.
  [[nodiscard]] bool has(int block) const;
  /// Reads an existing block with the same checks.
  [[nodiscard]] formats::StudyBlock read(int block) const;
  void write(int block, Eigen::VectorXi status, formats::StudyRows values) const;
  /// Samples of missing blocks, "0 to 99, 300 to 399"; empty if none is missing.
  [[nodiscard]] std::string missing() const;
  /// Removes the folder.
  void remove() const;
  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  [[nodiscard]] std::string path(int block) const;
  void check_origin(const formats::StudyBlock& found, const std::string& path) const;

  std::string folder_;
  formats::StudyOrigin origin_;
  std::uint64_t n_samples_;
  int size_, n_blocks_;
  Eigen::Index n_columns_;
};

}  // namespace fastjoint::stage3
