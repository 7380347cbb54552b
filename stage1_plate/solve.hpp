// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_solution.hpp"
#include "stage1_plate/contact.hpp"
#include "stage1_plate/plate_problem.hpp"

namespace fastjoint::stage1 {

/// All unit cases of one degree: factorises the leading block of K_ff once and solves one block of right-hand sides.
/// @param mixture (h, w) weights of the friction cases in each mixture of them that is solved, stress.
[[nodiscard]] formats::PlateCases solve_degree(const PlateProblem& problem, int p, const Eigen::MatrixXd& mixture);

/// What stage 2 is to make of the plate.
enum class Wanted { loads_and_stresses, loads };

/// What stage 2 needs of the scene, the mesh and the problem, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator,
                                                 Wanted wanted);

/// Sets the contacts and the loads of a scene that has them.
void add_contact(const ContactState& state, formats::PlateSolution& solution);

/// Solves all cases of every degree. The friction fields are needed for stresses alone, at the two highest degrees;
/// without stresses, one mixture of them at the highest checks reciprocity.
void solve_cases(const PlateProblem& problem, formats::PlateSolution& solution);

}  // namespace fastjoint::stage1
