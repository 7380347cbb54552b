// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include "tests/support/plates.hpp"

namespace fastjoint::test {

/// Stiffness among the free unknowns at the highest p, shape (n_f, n_f), both triangles, the plain way: every element
/// and every side of a rim integrated on its own, nothing condensed.
[[nodiscard]] Eigen::SparseMatrix<double> free_stiffness(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh,
                                                         const stage1::PlateProblem& problem);

/// What PlateFactor::condensed gives at degree p, rows of friction cases included, every column of the border solved by
/// a sparse factor of all free unknowns: with U and V the fields of unit displacements and of unit waves and friction
/// cases, [K_cc + K_cf U, K_cf V - L_c; -L_f^T U - L_c^T, -L_f^T V].
[[nodiscard]] Eigen::MatrixXd plain_matrices(const Eigen::SparseMatrix<double>& K_ff, const Problem& problem, int p);

}  // namespace fastjoint::test
