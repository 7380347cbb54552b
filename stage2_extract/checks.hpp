// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "common/formats/plate_matrices.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Largest absolute entry, 0 of an empty matrix: what all checks are relative to.
[[nodiscard]] double largest(const Eigen::MatrixXd& A);

/// What must hold whatever the mesh, at the highest p; each relative to the largest entry of what it compares.
struct Checks {
  double symmetry;             ///< largest |S - S^T|
  double smallest_eigenvalue;  ///< of S, over the largest
  std::optional<double>
      reciprocity;  ///< reactions to friction and to tractions by unit fields against those by solving
  std::optional<double> equilibrium;  ///< force left when all discs and boundaries move together; none if supports hold
};

/// @param S (nc, nc) not made symmetric.
[[nodiscard]] Checks check(const formats::PlateSolution& plate, const formats::PlateMatrices& matrices,
                           const Eigen::MatrixXd& S);

/// Throws NumericalError with the name of the file and of the check that fails.
void require_good(const Checks& checks, const std::string& file);

/// One line each, for the summary.
[[nodiscard]] std::string report(const Checks& checks);

}  // namespace fastjoint::stage2
