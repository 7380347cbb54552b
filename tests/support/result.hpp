// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/joint_result.hpp"

namespace fastjoint::test {

/// A RESULT.h5: what formats::read_joint_result reads, and more of its numbers, with all extents after the first as
/// columns.
struct Result : formats::JointResult {
  /// Throws FileError for a bad file.
  explicit Result(const std::string& path);

  /// Numbers of a dataset. Throws FileError without it.
  [[nodiscard]] Eigen::MatrixXd operator[](const std::string& dataset) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& dataset) const;
  [[nodiscard]] bool has(const std::string& dataset) const;

  Eigen::MatrixXd F, delta, F_vector, delta_vector, transferred;

 private:
  std::string path_;
};

}  // namespace fastjoint::test
