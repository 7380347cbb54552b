// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/bending.hpp"
#include "stage3_nonlinear/study/study_outputs.hpp"

namespace fastjoint::stage3 {

/// Status of a sample, in the order of the numbers in STUDY.h5.
enum class SampleStatus { solved, refused, not_solved, out_of_balance };

/// Results of a sample at the last increment.
struct SampleNumbers {
  SampleStatus status = SampleStatus::solved;
  VectorXd all;  ///< in the order of StudyOutputs; NaN if not solved
  VectorXd c{};  ///< (cases r) contact coordinates; empty if not solved
};

/// Solves one load case of a joint for other parameters.
class CaseSolver {
 public:
  /// @param joint   Outlives this; has friction wherever a sample has some.
  /// @param scene   With every variable in its middle; its cases and solver are used.
  /// @param at      Number of the case.
  CaseSolver(const JointModel& joint, const JointScene& scene, std::size_t at,
             std::shared_ptr<const CondensedSystem> system);

  /// Number of the case.
  [[nodiscard]] std::size_t at() const { return at_; }
  /// Passes the equations and the last state with the parameters of a scene to `use`; false if not solved.
  /// @param away Change of the contact coordinates from those of the middle to the start of the solver, (r); empty: 0.
  template <class Use>
  bool solve(const JointScene& scene, const VectorXd& away, Use use) const {
    JointEquations equations = equations_of(scene, at_);
    auto step = from_middle(equations, away);
    if (!step) step = from_no_load(scene, equations.history);
    if (step) use(equations, *step);
    return step.has_value();
  }

 private:
  /// Equations of a case under the last loads of the cases before it.
  [[nodiscard]] JointEquations equations_of(const JointScene& scene, std::size_t at) const;
  [[nodiscard]] std::optional<PathStep> from_middle(const JointEquations& equations, const VectorXd& away) const;
  /// Follows the cases before this and this from no load through all increments.
  /// @param history Is set to that at the start of the last increment.
  [[nodiscard]] std::optional<PathStep> from_no_load(const JointScene& scene, std::vector<History>& history) const;

  const JointModel& joint_;
  std::size_t at_;
  double load_factor_;  ///< the last
  bool has_path_;       ///< the case has other increments or cases before its last
  PathOptions options_;
  std::shared_ptr<const CondensedSystem> system_;
  std::vector<std::shared_ptr<const RimProblem>> rims_;  ///< solved in the middle
  std::optional<PathStep> middle_;  ///< last state with every variable in its middle; none if not solved
};

/// Solves the load cases of a joint for other parameters, each time from the solution with all variables in their
/// middle, so that no result depends on another sample. Several threads may use it.
///
/// The numbers of a sample are the envelope of its cases: the largest of each, of displacements and K_II those of the
/// largest magnitude.
class StudySolver {
 public:
  /// @param joint Outlives this; has friction wherever a sample has some.
  /// @param scene With every variable in its middle. @param cases Numbers of the cases to solve.
  StudySolver(const JointModel& joint, const JointScene& scene, const std::vector<std::size_t>& cases,
              StudyOutputs outputs);

  [[nodiscard]] const StudyOutputs& outputs() const { return outputs_; }
  /// Results for the parameters of the middle; NaN if not solved.
  [[nodiscard]] const SampleNumbers& middle() const { return middle_; }
  /// Results for other parameters; away from the middle as in CaseSolver, for all cases one after another.
  [[nodiscard]] SampleNumbers solve(const JointScene& scene, const VectorXd& away = {}) const;
  /// Results of a sample that was not solved.
  [[nodiscard]] SampleNumbers nothing(SampleStatus status) const {
    return {status, VectorXd::Constant(outputs_.size(), std::numeric_limits<double>::quiet_NaN()), {}};
  }

 private:
  /// Numbers of one case; not finite if it is out of balance.
  [[nodiscard]] VectorXd numbers(const JointEquations& equations, const PathStep& step,
                                 const std::string& case_name) const;

  const JointModel& joint_;
  Bending bending_;
  double tolerance_;
  std::vector<CaseSolver> cases_;
  StudyOutputs outputs_;
  SampleNumbers middle_;
};

}  // namespace fastjoint::stage3
