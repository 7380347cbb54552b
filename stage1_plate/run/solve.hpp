// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_solution.hpp"
#include "common/program/timings.hpp"
#include "stage1_plate/contact/contact.hpp"
#include "stage1_plate/factor/skeleton.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// What stage 2 is to make of the plate.
enum class Wanted { loads_and_stresses, loads };

/// What stage 2 needs of the scene, the mesh and the problem, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator,
                                                 Wanted wanted);

/// Sets the contacts and the loads of a scene that has them.
void add_contact(const ContactState& state, formats::PlateSolution& solution);

/// Factorises the plate at every degree and solves what stage 2 reads: all fields at the degrees whose stresses are
/// wanted, elsewhere those of tractions only, and at the highest degree the probe. Phases: factorise, solve.
void solve_cases(const PlateProblem& problem, const Skeleton& skeleton, formats::PlateSolution& solution,
                 program::Timings& timings);

}  // namespace fastjoint::stage1
