// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/results/force_errors.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/load_stiffness.hpp"
#include "stage3_nonlinear/results/peak_sensitivity.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {

/// What is wanted of each increment.
struct Wanted {
  double tolerance;               ///< of the solver
  bool sensitivities = false;     ///< derivatives of forces, and at the last increment those of peaks
  bool keep_loaded_rims = false;  ///< PlateState::loaded, which takes memory
};

/// Results of all increments of a path, each made while the tangent of its solution is at hand.
struct Increments {
  std::vector<JointState> states;
  std::optional<MatrixXd> F_error;                     ///< (steps, n) force; none if not known (ForceErrors)
  std::vector<std::vector<LoadStiffness>> stiffness;   ///< of each increment
  JointNumbers numbers;                                ///< that results are differentiated by, if wanted
  std::vector<Sensitivity> sensitivity;                ///< of each increment, if wanted
  std::optional<PeakSensitivity> peak = std::nullopt;  ///< at the last increment, if wanted
};

/// Part of a state that is out of balance, if it is by more than 1e-8 of the largest force or what the solver's
/// tolerance leaves.
[[nodiscard]] std::optional<Imbalance> imbalance(const JointState& state, double tolerance);

/// Follows a joint and keeps the results of each increment. The path ends where forces do not balance to 1e-8 of the
/// largest or to what the solver's tolerance leaves, since rounding errors would count as load.
/// @param load_factors None: increments at every event (follow_events).
[[nodiscard]] std::pair<LoadPath, Increments> follow_with_results(const JointModel& joint,
                                                                  const JointEquations& equations,
                                                                  const std::vector<double>& load_factors,
                                                                  PathOptions options, const Wanted& wanted);

}  // namespace fastjoint::stage3
