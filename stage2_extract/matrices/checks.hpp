// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Largest absolute entry, 0 of an empty matrix: what all checks are relative to.
[[nodiscard]] double largest(const Eigen::MatrixXd& A);

/// A direction that no support fixes and that the disc of every hole can move along, and what acts along it in unit
/// cases.
struct FreeTranslation {
  std::string along;            ///< "x" or "y"
  Eigen::VectorXd motion;       ///< (nc) of externals and discs together
  Eigen::RowVectorXd friction;  ///< (h) resultant of each friction case, length^2
  Eigen::RowVectorXd traction;  ///< (q) resultant of a unit total force on each traction boundary
  Eigen::VectorXd waves;        ///< (w) integrals over rims without a disc, along which the sheet moves, length^2
};

/// @param a Names of the cases, and the resultants of friction and tractions along and across their directions.
[[nodiscard]] std::vector<FreeTranslation> free_translations(const formats::PlateSolution& plate,
                                                             const formats::PlateMatrices& a);

/// Errors of identities that hold whatever the mesh, at the highest p; each relative to the largest entry of what it
/// compares.
struct Checks {
  std::optional<double> energy;  ///< forces under a mixture of unit displacements, by S against by its own solution
  std::optional<double> reciprocity;          ///< the same of pressures, friction and tractions, by B, C, R and T
  std::optional<double> negative_eigenvalue;  ///< the smallest of S, if it is further below zero than allowed
  std::optional<double> negative_compliance;  ///< the same of C
  std::optional<double> equilibrium;  ///< force left when all discs and boundaries move together; none if supports hold
  double rounding = 0;  ///< what rounding may change of S, as stage 1 has estimated it; it is part of the error of S
};

/// @param a As free_translations has it.
[[nodiscard]] Checks check(const formats::PlateSolution& plate, const formats::PlateMatrices& a);

/// Throws NumericalError with the name of the file and of the check that fails.
void require_good(const Checks& checks, const std::string& file);

/// One line each, for the summary.
[[nodiscard]] std::string report(const Checks& checks);

}  // namespace fastjoint::stage2
