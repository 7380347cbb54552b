// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "common/formats/plate_solution.hpp"
#include "common/program/timings.hpp"
#include "stage1_plate/contact/contact.hpp"
#include "stage1_plate/run/memory.hpp"

namespace fastjoint::stage1 {

/// The scene, the mesh and the problem as stage 2 needs them, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator);

/// Sets the contacts and the loads of a scene that has them.
void add_contact(const RimContactState& state, formats::PlateSolution& solution);

/// The unit cases at one degree, and the probe that checks them.
struct SolvedCases {
  formats::PlateCases cases;
  formats::Probe probe;
};
[[nodiscard]] SolvedCases solve_degree(const PlateProblem& problem, const plate::PlateFactor& K, int p);

/// Solves the unit cases at every degree, and at the highest the probe. Phases: factorise, solve.
void solve_cases(const PlateProblem& problem, const plate::Skeleton& skeleton, formats::PlateSolution& solution,
                 program::Timings& timings);

/// A scene and what became of it.
struct SolvedPlate {
  PlateScene scene;  ///< with springs on the arcs that contact has found
  std::optional<RimContactState> contact;
  MemoryNeed need;
  formats::PlateSolution solution;
};

/// Mesh, matrices, contact if the scene has loads, unit cases. Phases: mesh, integrate, factorise, solve.
/// Throws InputError for a scene that does not fit together or into memory, NumericalError for one that moves.
[[nodiscard]] SolvedPlate solve_plate(PlateScene scene, const std::string& generator, program::Timings& timings);

/// A line for each hole with contact: the arcs on which its springs push, the iterations, the largest pressure.
[[nodiscard]] std::string contact_summary(const PlateScene& scene, const RimContactState& state);

/// The summary on stdout: size, degrees and contacts. @param file Where the plate has been written.
[[nodiscard]] std::string summary(const SolvedPlate& plate, const std::string& file);

}  // namespace fastjoint::stage1
