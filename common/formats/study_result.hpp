// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/formats/header.hpp"
#include "common/formats/study_block.hpp"

namespace fastjoint::formats {

/// Statistics of n numbers of one kind over all samples of a study, which vary v variables.
struct StudyGroup {
  std::string name, unit;                    ///< "force", ...
  std::vector<std::string> of;               ///< (n) names
  Eigen::VectorXd middle;                    ///< (n) of the joint whose variables are in the middle
  Eigen::VectorXd mean, deviation;           ///< (n) of the samples that were solved
  Eigen::VectorXd by_sensitivities;          ///< (n) deviation by the sensitivities in the middle alone
  Eigen::MatrixXd quantile, low, high;       ///< (n, 4) and their confidence limits; infinite where samples are too few
  Eigen::MatrixXd sensitivity, correlation;  ///< (n, v) in the middle; Spearman's
  Eigen::VectorXd governs;                   ///< (n) share of the samples in which it is the largest
  double limit = std::numeric_limits<double>::infinity();  ///< whose exceedance is counted, if it is finite
  Eigen::VectorXd exceeds, exceeds_low, exceeds_high;      ///< (n) share of the samples and its confidence limits
};

/// A study: statistics of its samples.
struct StudyResult {
  Header header;  ///< of the joint
  StudyOrigin origin;
  std::string sampling;
  std::vector<std::string> variable, place;  ///< (v) names, and JSON pointers, parted by spaces
  Eigen::VectorXd middle, mean, deviation;   ///< (v) of the variables
  std::uint64_t n_samples = 0;
  Eigen::VectorXi n_status;  ///< (4) samples of each status
  std::vector<StudyGroup> groups;
};

/// Writes STUDY.h5. @param samples Makes its datasets of one row for each sample.
void write(const std::string& path, const StudyResult& result, const std::function<void(h5::Writer&)>& samples);

}  // namespace fastjoint::formats
