// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tests/bench/peer_plate.hpp"

namespace fastjoint::peer {

/// Points of a rim, at equal angles counter-clockwise from +x on: those of stage2_extract.
inline constexpr unsigned int n_angles = 72;
inline constexpr double degrees_between = 360.0 / n_angles;

/// Hoop stress at the points of all rims, hole by hole, for unit displacements of the external and of each disc, shape
/// (n_holes n_angles, n_controlled), force / length^3: the finite element stress as it comes, mean of both cells where
/// two meet. It is found as a user would first write it, case by case and cell by cell.
///
/// @param U Rows of the system in each case, shape (n_rows, n_controlled).
[[nodiscard]] Eigen::MatrixXd hoop_stress(const Discretisation& plate, const Eigen::MatrixXd& U);

/// The same where insides of cells are left out. The stresses of one square's rim by its unknowns stand for those of
/// all; one product for each rim gives those of all cases.
///
/// @param insides What condense() returned for the cells of the square.
[[nodiscard]] Eigen::MatrixXd hoop_stress(const Discretisation& plate, const std::vector<Eigen::MatrixXd>& insides,
                                          const Eigen::MatrixXd& U);

}  // namespace fastjoint::peer
