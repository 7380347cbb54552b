// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <vector>

#include "stage3_nonlinear/results/case_run.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the stress intensity factors of one plate, (steps, t), stress length^1/2; infinite if the
/// matrices have one degree only, or if the joint does not converge at the degree below.
struct CrackErrors {
  MatrixXd K_I, K_II;
};

/// Estimates the errors of each plate's factors at every increment of load cases: each case is solved again at up to
/// two lower degrees, whose sequence is extrapolated (geometric_error); in contact the estimated part of the waves that
/// are left out is added.
class CrackErrorEstimate {
 public:
  /// Loads the joint at lower degrees if it has cracks.
  /// @param scene As the joint was read from; outlives this.
  CrackErrorEstimate(const JointScene& scene, const JointModel& joint);

  /// Errors at the increments of a case, one entry for each plate.
  [[nodiscard]] std::vector<CrackErrors> of(const JointModel& joint, std::size_t its_case, const LoadPath& path,
                                            const std::vector<JointState>& states, const PathOptions& options);

 private:
  /// The joint at a lower degree.
  struct Degree {
    JointModel joint;
    CaseRun cases;
    Degree(const JointScene& scene, int p) : joint(load_joint(scene, p)), cases(scene, joint) {}
  };
  double tolerance_;
  std::deque<Degree> below_;  ///< the highest first
};

}  // namespace fastjoint::stage3
