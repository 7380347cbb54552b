// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>

#include "common/formats/plate_solution.hpp"
#include "common/plate/plate_factor.hpp"
#include "common/program/progress.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Bytes that a run takes, known before anything is integrated: at its highest degree, on several threads at as many.
struct MemoryNeed {
  double elements;  ///< matrices of the classes of elements
  double factor;    ///< the skeleton's stiffness and its factor
  double fields;    ///< fields of tractions and of the probe, and the rows of S, R and W while they are made
  double file;  ///< S, R and W of all degrees as they are turned to the order of the file, when the factors are gone
  double program;

  [[nodiscard]] double total() const {
    constexpr double gaps = 1.15;  // what the allocator cannot use between them, and what integrating takes
    return gaps * (elements + std::max(factor + fields, file)) + program;
  }
};
/// @param problem    Result of number_unknowns.
/// @param p          Degrees to be solved, ascending.
/// @param n_sections Whose forces are found too.
[[nodiscard]] MemoryNeed memory_need(const PlateProblem& problem, const plate::Skeleton& skeleton,
                                     const Eigen::VectorXi& p, int n_sections = 0);

/// Throws InputError, which says how much degree p needs and for what, if it is more than is available.
void require_memory(const std::string& file, int p, const MemoryNeed& need);

/// The scene, the mesh and the problem as stage 2 needs them, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator);

/// The unit cases at one degree, and the probe that checks them.
struct SolvedCases {
  formats::PlateCases cases;
  formats::Probe probe;
};
/// @param sections Forces over the plate's sections; none at degrees without.
[[nodiscard]] SolvedCases solve_degree(const PlateProblem& problem, const plate::PlateFactor& K, int p,
                                       const plate::PlateFactor::Functions& sections = {});

/// Solves the unit cases at every degree, on several threads side by side, and at the highest the probe.
void solve_cases(const PlateProblem& problem, const plate::Skeleton& skeleton, formats::PlateSolution& solution);

/// What became of a scene.
struct SolvedPlate {
  MemoryNeed need;
  formats::PlateSolution solution;
  std::vector<std::string> missing_symmetry;  ///< warnings
};

/// Mesh, matrices, unit cases. Phases: mesh, integrate, solve.
/// Throws InputError for a scene that does not fit together or into memory, NumericalError for one that moves.
[[nodiscard]] SolvedPlate solve_plate(const PlateScene& scene, const std::string& generator, program::Timings& timings);

/// The summary on stdout: size and degrees. @param file Where the plate has been written.
[[nodiscard]] std::string summary(const SolvedPlate& plate, const std::string& file);

}  // namespace fastjoint::stage1
