// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/results/bending.hpp"
#include "stage3_nonlinear/results/force_errors.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/load_stiffness.hpp"
#include "stage3_nonlinear/results/peak_sensitivity.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "stage3_nonlinear/strength/stress_ranges.hpp"

namespace fastjoint::stage3 {

/// Requested results of each increment.
struct Wanted {
  double tolerance;                  ///< of the solver
  bool sensitivities = false;        ///< derivatives of forces, and at the last increment those of peaks
  const Bending* bending = nullptr;  ///< computes secondary bending, if wanted
  bool keep_loaded_rims = false;     ///< PlateState::loaded, which takes memory
};

/// Results of all increments of a path, computed with the tangent of each solution.
struct Increments {
  std::vector<JointState> states;
  std::vector<SpotExtremes> spots;                     ///< of the plates
  std::optional<MatrixXd> F_error;                     ///< (steps, n) force; none if not known (ForceErrors)
  std::vector<std::vector<LoadStiffness>> stiffness;   ///< of each increment
  JointNumbers numbers;                                ///< parameters of the derivatives, if wanted
  std::vector<MatrixXd> sensitivity;                   ///< of the forces, of each increment, if wanted
  std::optional<PeakSensitivity> peak = std::nullopt;  ///< at the last increment, if wanted
};

/// Estimated errors of the forces of shear planes, if known, and the stiffness of the joint under its loads.
[[nodiscard]] std::vector<JointGroup> increment_quantities(const Increments& increments);

/// Part of a state that is out of balance by more than 1e-8 of the largest force and more than ten times the solver's
/// tolerance, or the load, if rounding of the gaps is as large a part of it.
[[nodiscard]] std::optional<Imbalance> imbalance(const JointEquations& equations, const PathStep& step,
                                                 const JointState& state, double tolerance);

/// Follows a joint and keeps the results of each increment. The path ends at an imbalance, since rounding errors would
/// then act as loads.
/// @param load_factors If empty, there are increments at every event (follow_events).
[[nodiscard]] std::pair<LoadPath, Increments> follow_with_results(const JointModel& joint,
                                                                  const JointEquations& equations,
                                                                  const std::vector<double>& load_factors,
                                                                  PathOptions options, const Wanted& wanted);

}  // namespace fastjoint::stage3
