// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// What a study is made from: results belong together where all of it is the same.
struct StudyOrigin {
  std::string generator;                  ///< program and version
  std::string joint;                      ///< text of JOINT.json
  std::string study;                      ///< text of STUDY.json
  std::string seed;                       ///< of the random numbers, decimal
  std::vector<std::string> file, digest;  ///< (f) files that these name, and the degree, each with its digest or number
};

using StudyRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Solved samples of a study, a part of it that is a file of its own.
struct StudyBlock {
  StudyOrigin origin;
  int number = 0;          ///< of the block
  int size = 0;            ///< samples of all blocks but the last
  Eigen::VectorXi status;  ///< (k) of each sample, SampleStatus
  StudyRows values;        ///< (k, columns), infinite of a sample that is not solved
};

void write(const std::string& path, const StudyBlock& block);
/// Throws FileError if the file is damaged or of another kind.
[[nodiscard]] StudyBlock read_study_block(const std::string& path);

}  // namespace fastjoint::formats
