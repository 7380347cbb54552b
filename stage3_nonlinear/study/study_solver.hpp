// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

/// Status of a sample, in the order of the numbers in STUDY.h5.
enum class SampleStatus { solved, refused, not_solved, out_of_balance };

/// Results of a sample at the last increment.
struct SampleNumbers {
  SampleStatus status = SampleStatus::solved;
  VectorXd all;  ///< in the order of StudyNames: forces, peaks, displacements, K_I, K_II; NaN if not solved
  VectorXd c{};  ///< (r) contact coordinates; empty if not solved
};

/// Names of the numbers of a sample.
struct StudyNames {
  std::vector<std::string> force;         ///< fastener, and its plates if it has several planes
  std::vector<std::string> peak;          ///< "plate:hole"; empty if not requested
  std::vector<std::string> displacement;  ///< "plate:external" of rigid externals; empty if not requested
  std::vector<std::string> crack;         ///< "plate:tip" of K_I and of K_II; empty if not requested

  [[nodiscard]] Index size() const {
    return std::ssize(force) + std::ssize(peak) + std::ssize(displacement) + 2 * std::ssize(crack);
  }
};

[[nodiscard]] StudyNames study_names(const JointModel& joint, const StudyScene& study);

/// Solves a joint for other parameters, each time from its solution with all variables in their middle, so that no
/// result depends on another sample. Several threads may use it.
class StudySolver {
 public:
  /// @param joint  Outlives this; has friction wherever a sample has some.
  /// @param scene  Its load factors and solver are used.
  /// @param middle Parameters with every variable in its middle.
  StudySolver(const JointModel& joint, const JointScene& scene, const Parameters& middle, StudyNames names);

  [[nodiscard]] const StudyNames& names() const { return names_; }
  /// Results for the parameters of the middle; NaN if not solved.
  [[nodiscard]] const SampleNumbers& middle() const { return middle_; }
  /// Results for other parameters.
  /// @param away Change of the contact coordinates from those of the middle to the start of the solver, (r); empty: 0.
  [[nodiscard]] SampleNumbers solve(const Parameters& parameters, const VectorXd& away = {}) const;
  /// Results of a sample that was not solved.
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
