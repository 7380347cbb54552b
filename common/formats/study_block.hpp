// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Inputs of a study. Only blocks with equal inputs may be combined.
struct StudyOrigin {
  std::string generator;                  ///< program and version
  std::string joint;                      ///< text of JOINT.json
  std::string study;                      ///< text of STUDY.json
  std::string seed;                       ///< seed of the random numbers, decimal
  std::vector<std::string> file, digest;  ///< (f) files named in these with their digests, and the degree
};

using StudyRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Some of the solved samples of a study, in a separate file.
struct StudyBlock {
  StudyOrigin origin;
  int number = 0;          ///< number of the block
  int size = 0;            ///< number of samples in each block but the last
  Eigen::VectorXi status;  ///< (k) SampleStatus of each sample
  StudyRows values;        ///< (k, columns), infinite for a sample that is not solved
};

void write(const std::string& path, const StudyBlock& block);
/// Throws FileError if the file is damaged or of another kind.
[[nodiscard]] StudyBlock read_study_block(const std::string& path);

}  // namespace fastjoint::formats
