// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>

#include "common/errors.hpp"
#include "common/formats/plate_solution.hpp"
#include "common/pfem/extremes.hpp"
#include "common/plate/plate_factor.hpp"
#include "common/program/progress.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Memory of a run in bytes, known before integration: that of its highest degree, with several threads of as many
/// degrees.
struct MemoryNeed {
  double elements;  ///< matrices of the classes of elements
  double factor;    ///< the skeleton's stiffness and its factor
  double fields;    ///< fields of tractions and of the probe, and the rows of S, R and W during elimination
  double file;      ///< S, R and W of all degrees and their copies in the file's order, after the factors are freed
  double program;

  [[nodiscard]] double total() const {
    constexpr double gaps = 1.15;  // fragmentation, and temporary memory of the integration
    return gaps * (elements + std::max(factor + fields, file)) + program;
  }
};
/// @param problem    Result of number_unknowns.
/// @param p          Degrees to be solved, ascending.
/// @param n_sections Number of sections whose forces are computed.
[[nodiscard]] MemoryNeed memory_need(const PlateProblem& problem, const plate::Skeleton& skeleton,
                                     const Eigen::VectorXi& p, int n_sections = 0);

/// Throws InputError with the need of degree p and its parts if it exceeds the available memory.
void require_memory(const std::string& file, int p, const MemoryNeed& need);

/// Converts scene, mesh and problem to the data for stage 2, without the cases.
[[nodiscard]] formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate,
                                                 const PlateProblem& problem, const std::string& generator);

/// The unit cases at one degree, and the probe to check them.
struct SolvedCases {
  formats::PlateCases cases;
  formats::Probe probe;
};
/// @param sections Forces over the plate's sections, empty to omit them. @param intensities As of stress_intensities.
[[nodiscard]] SolvedCases solve_degree(const PlateProblem& problem, const plate::PlateFactor& K, int p,
                                       const plate::PlateFactor::Functions& sections = {},
                                       const plate::PlateFactor::Functions& intensities = {});

/// Calls a function, and adds the file and the extremes of the plate's numbers to the message of its NumericalError.
template <class Function>
auto with_extremes(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem, Function function) {
  try {
    return function();
  } catch (const NumericalError& e) {
    throw NumericalError(scene.file + ": " + e.what() + ": " +
                         pfem::extremes(plate.mesh, scene.elasticity, plate::spring_stiffnesses(problem)));
  }
}

/// Solves the unit cases at every degree, in parallel on several threads, and the probe at the highest.
void solve_cases(const PlateProblem& problem, const plate::Skeleton& skeleton, formats::PlateSolution& solution);

/// The result of stage 1 for a scene.
struct SolvedPlate {
  MemoryNeed need;
  formats::PlateSolution solution;
  std::vector<std::string> missing_symmetry, few_waves;  ///< warnings
  std::vector<std::string> moved_lines{};                ///< of PlateMesh
};

/// Mesh, matrices, unit cases. Phases: mesh, integrate, solve.
/// Throws InputError for a scene that is inconsistent or too large for the memory, NumericalError for rigid body
/// motions.
[[nodiscard]] SolvedPlate solve_plate(const PlateScene& scene, const std::string& generator, program::Timings& timings);

/// The summary on stdout: size and degrees. @param file Path of the written file.
[[nodiscard]] std::string summary(const SolvedPlate& plate, const std::string& file);

/// The bays of the sheet as a beam along x and along y; none in plane strain.
/// @param border Its outline. @param places Of its discs, at whose rows bays end.
[[nodiscard]] std::vector<formats::Bay> bays_of(const PlateScene& scene, const PlateMesh& plate,
                                                const formats::Border& border, const formats::Places& places);

/// Places at which discs, externals and supports act on the plate.
[[nodiscard]] formats::Places places_of(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem);

}  // namespace fastjoint::stage1
