// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "stage3_nonlinear/study/sampled_joint.hpp"
#include "stage3_nonlinear/study/study_blocks.hpp"
#include "stage3_nonlinear/study/study_solver.hpp"

namespace fastjoint::stage3 {

/// The study and the joint that it varies.
struct Study {
  input::Document joint_text, study_text;
  JointScene joint;
  StudyScene scene;
};

/// Samples of a study on all threads. Each starts from the solution with all variables in their middle, so that it does
/// not depend on other samples.
class Samples {
 public:
  /// Solves near the middle for the slopes there. @param study, solver Outlive this.
  Samples(const Study& study, std::uint64_t seed, const StudySolver& solver);

  /// (columns, v) derivative of each number by each variable in the middle; infinite if not known.
  [[nodiscard]] const MatrixXd& sensitivity() const { return slopes_; }
  /// Solves the samples of a block and writes it.
  void solve_block(const StudyBlocks& blocks, int block);

 private:
  /// Solves the joint for values of the variables.
  SampleNumbers of_values(const std::vector<double>& values);
  /// Finds the derivatives of all numbers, and of the contact coordinates, by each variable in the middle, by central
  /// differences.
  void find_slopes();
  /// Change of the contact coordinates from the middle to values of the variables, by these slopes; empty before they
  /// are known.
  [[nodiscard]] VectorXd away(const std::vector<double>& values) const;
  /// Takes an unused joint for the current thread; `give` returns it.
  std::unique_ptr<SampledJoint> take();
  void give(std::unique_ptr<SampledJoint> sampled);

  const Study& study_;
  std::uint64_t seed_;
  const StudySolver& solver_;
  std::vector<double> middle_;
  MatrixXd slopes_, c_slopes_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<SampledJoint>> spare_;
};

}  // namespace fastjoint::stage3
