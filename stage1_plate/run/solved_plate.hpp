// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "stage1_plate/run/memory.hpp"

namespace fastjoint::stage1 {

/// A scene and what became of it.
struct SolvedPlate {
  PlateScene scene;  ///< with springs on the arcs that contact has found
  std::optional<ContactState> contact;
  MemoryNeed need;
  formats::PlateSolution solution;
};

/// Mesh, matrices, contact if the scene has loads, unit cases. Phases: mesh, integrate, factorise, solve.
/// Throws InputError for a scene that does not fit together or into memory, NumericalError for one that moves.
[[nodiscard]] SolvedPlate solve_plate(PlateScene scene, Wanted wanted, const std::string& generator,
                                      program::Timings& timings);

/// Size, degrees and contacts, for people. @param file Where it has been written.
[[nodiscard]] std::string summary(const SolvedPlate& plate, const std::string& file);

}  // namespace fastjoint::stage1
