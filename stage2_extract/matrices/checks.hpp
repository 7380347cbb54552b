// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Largest absolute value of an entry, 0 for an empty matrix.
[[nodiscard]] double largest(const Eigen::MatrixXd& A);

/// A direction without support along which the disc of every hole can move, with the resultants of the unit cases along
/// it.
struct FreeTranslation {
  rim::Axis axis;
  Eigen::VectorXd motion;       ///< (nc) unit translation of all externals and discs
  Eigen::RowVectorXd friction;  ///< (h) resultant of each friction case, length^2
  Eigen::RowVectorXd traction;  ///< (q) resultant of a unit total force on each traction boundary
  Eigen::VectorXd waves;        ///< (w) integrals over rims of open holes for this translation of the sheet, length^2
};

/// @param a Matrices with the names of the cases and the resultants of friction and tractions.
[[nodiscard]] std::vector<FreeTranslation> free_translations(const formats::PlateSolution& plate,
                                                             const formats::PlateMatrices& a);

/// Errors of identities that hold on any mesh, at the highest p, each relative to the largest entry of the compared
/// matrix.
struct Checks {
  std::optional<double> energy;  ///< forces of the probe's displacements by S, compared with the probe's own solution
  std::optional<double> reciprocity;          ///< the same for waves, friction and tractions by W, R and T
  std::optional<double> negative_eigenvalue;  ///< smallest eigenvalue of S, if it is below the allowed negative value
  std::optional<double> negative_compliance;  ///< the same for the compliances of loaded waves
  std::optional<double> equilibrium;          ///< resultant along free translations; empty if supports prevent them
  double rounding = 0;        ///< bound of the change of S by rounding, estimated by stage 1; part of the error of S
  std::string extremes = {};  ///< of the plate, which may be why a check fails
};

/// @param a As in free_translations.
[[nodiscard]] Checks check(const formats::PlateSolution& plate, const formats::PlateMatrices& a);

/// Throws NumericalError with the name of the file and of the failed check, and what of the plate may have caused it.
void require_good(const Checks& checks, const std::string& file);

/// The checks as a line of the summary.
[[nodiscard]] std::string report(const Checks& checks);

}  // namespace fastjoint::stage2
