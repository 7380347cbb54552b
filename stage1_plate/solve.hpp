// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_solution.hpp"
#include "stage1_plate/plate_problem.hpp"

namespace fastjoint::stage1 {

/// All unit cases of one degree: factorises the leading block of K_ff once and solves one block of right-hand sides.
/// @param probe (h) weights of the friction cases in the probe that checks reciprocity, stress.
[[nodiscard]] formats::PlateCases solve_degree(const PlateProblem& problem, int p, const Eigen::VectorXd& probe);

/// Weights that no symmetry of the plate cancels: 1, 2, 3, ... over their number.
[[nodiscard]] Eigen::VectorXd probe_weights(Eigen::Index n_friction_cases);

/// What stage 2 needs of the scene, the mesh and the problem, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator);

}  // namespace fastjoint::stage1
