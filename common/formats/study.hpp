// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
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

/// Statistics of n results of one kind over all samples of a study with v variables.
struct StudyGroup {
  std::string name, unit;                    ///< "force", ...
  std::vector<std::string> of;               ///< (n) names
  Eigen::VectorXd middle;                    ///< (n) results of the joint with every variable in the middle
  Eigen::VectorXd mean, deviation;           ///< (n) over the solved samples
  Eigen::VectorXd by_sensitivities;          ///< (n) linearised deviation, by the sensitivities in the middle
  Eigen::MatrixXd quantile, low, high;       ///< (n, 4) and their confidence limits; infinite where samples are too few
  Eigen::MatrixXd sensitivity, correlation;  ///< (n, v) sensitivity in the middle; Spearman's rank correlation
  Eigen::VectorXd governs;                   ///< (n) fraction of the samples in which it is the largest
  Eigen::VectorXd closed;                    ///< (n) of K_I alone: fraction of the samples in which it is negative
  double limit = std::numeric_limits<double>::infinity();  ///< infinite without one, or if each has its own
  Eigen::VectorXd limits;                                  ///< (n) for the next three; infinite without one
  Eigen::VectorXd exceeds, exceeds_low, exceeds_high;      ///< (n) fraction above it and its confidence limits
};

/// A study: statistics of its samples.
struct StudyResult {
  Header header;  ///< header of the joint
  StudyOrigin origin;
  std::string sampling;
  std::vector<std::string> variable, place;  ///< (v) names, and JSON pointers, parted by spaces
  Eigen::VectorXd middle, mean, deviation;   ///< (v) values of the variables
  std::uint64_t n_samples = 0;
  Eigen::VectorXi n_status;  ///< (4) number of samples of each status
  std::vector<StudyGroup> groups;
};

/// Writes STUDY.h5. @param samples Writes the datasets with one row for each sample.
void write(const std::string& path, const StudyResult& result, const std::function<void(h5::Writer&)>& samples);

}  // namespace fastjoint::formats
