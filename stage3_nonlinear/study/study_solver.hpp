// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

namespace fastjoint::stage3 {

/// What became of a sample, in the order of their numbers in STUDY.h5.
enum class SampleStatus { solved, refused, not_solved, out_of_balance };

/// Numbers that a study gets of a sample at the last increment.
struct SampleNumbers {
  SampleStatus status = SampleStatus::solved;
  VectorXd all;  ///< forces, then peaks, then displacements, as StudySolver::names; NaN if it was not solved
  VectorXd c{};  ///< (r) contact coordinates; none if it was not solved
};

/// Names of the numbers of a sample.
struct StudyNames {
  std::vector<std::string> force;         ///< fastener, and of one with several planes its plates
  std::vector<std::string> peak;          ///< "plate:hole"; none if not wanted
  std::vector<std::string> displacement;  ///< "plate:external" of the rigid ones; none if not wanted

  [[nodiscard]] Index size() const { return std::ssize(force) + std::ssize(peak) + std::ssize(displacement); }
};

[[nodiscard]] StudyNames study_names(const JointModel& joint, bool peaks, bool displacements);

/// Solves a joint for other numbers, each time from its solution for the numbers in the middle, so that no result
/// depends on another sample. Several threads may use it.
class StudySolver {
 public:
  /// @param joint  Outlives this; friction acts where any sample has it.
  /// @param scene  Its load factors and solver.
  /// @param middle Numbers of the middle.
  StudySolver(const JointModel& joint, const JointScene& scene, const Parameters& middle, StudyNames names);

  [[nodiscard]] const StudyNames& names() const { return names_; }
  /// Numbers of the joint in the middle; NaN if it was not solved.
  [[nodiscard]] const SampleNumbers& middle() const { return middle_; }
  /// @param away Change of the contact coordinates from those of the middle to where the search begins, (r); empty:
  /// none.
  [[nodiscard]] SampleNumbers solve(const Parameters& parameters, const VectorXd& away = {}) const;
  /// The same where the parameters could not be made.
  [[nodiscard]] SampleNumbers nothing(SampleStatus status) const;

 private:
  [[nodiscard]] SampleNumbers numbers(const JointEquations& equations, const PathStep& step) const;

  const JointModel& joint_;
  std::vector<double> load_factors_;
  PathOptions options_;
  double tolerance_;
  std::shared_ptr<const CondensedSystem> system_;
  std::vector<std::shared_ptr<const RimProblem>> rims_;  ///< solved in the middle
  std::optional<VectorXd> start_;                        ///< (r) contact coordinates there, force
  StudyNames names_;
  SampleNumbers middle_;
};

}  // namespace fastjoint::stage3
