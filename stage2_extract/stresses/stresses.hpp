// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/plate_matrices.hpp"
#include "stage2_extract/stresses/fields.hpp"

namespace fastjoint::stage2 {

/// Stresses at the rims and forces over the sections beside the holes in every unit case, at the two highest degrees.
/// @param solver Solver of the plate; null for names, places and areas alone, without stresses.
[[nodiscard]] formats::PlateStresses extract_stresses(const formats::PlateSolution& plate, FieldSolver* solver);

/// The same in other states instead of unit cases, at degree p and the one below that the plate has.
/// @param amounts Amount of each unit case, shape (n_cases, k).
[[nodiscard]] formats::PlateStresses extract_stresses(FieldSolver& solver, int p, const Eigen::MatrixXd& amounts);

/// Bytes of the stresses at the rims, which are by far the most of them, in a number of states.
[[nodiscard]] double stress_bytes(const formats::PlateSolution& plate, Eigen::Index n_states);

/// Bytes of the fields that they are taken from, as many as are solved at a time.
[[nodiscard]] double block_bytes(const formats::PlateSolution& plate, Eigen::Index n_states);

}  // namespace fastjoint::stage2
