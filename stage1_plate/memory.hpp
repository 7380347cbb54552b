// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/outline.hpp"
#include "stage1_plate/solve.hpp"

namespace fastjoint::stage1 {

/// Bytes that a run takes at its highest degree, known before anything is integrated.
struct MemoryNeed {
  double shapes;  ///< matrices of the different elements
  double factor;  ///< the outline's stiffness and its factor
  double fields;  ///< of the unit cases, and the file that they go into
  double program;

  [[nodiscard]] double total() const { return shapes + factor + fields + program; }
};
/// @param problem As number_unknowns has made it. @param p Degrees to be solved, ascending.
[[nodiscard]] MemoryNeed memory_need(const PlateProblem& problem, const Outline& outline, const Eigen::VectorXi& p,
                                     Wanted wanted);

/// Throws InputError, which says how much is needed and for what, if it is more than is available.
void require_memory(const PlateScene& scene, const MemoryNeed& need, double available);

/// "63 MB", "1.2 GB".
[[nodiscard]] std::string bytes_text(double bytes);

}  // namespace fastjoint::stage1
