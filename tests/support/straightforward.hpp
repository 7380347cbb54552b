// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include "tests/support/plates.hpp"

namespace fastjoint::test {

/// Stiffness among the free unknowns at the highest p, shape (n_f, n_f), both triangles, the plain way: every element
/// and every side of a rim integrated on its own, nothing condensed.
[[nodiscard]] Eigen::SparseMatrix<double> free_stiffness(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh,
                                                         const stage1::PlateProblem& problem);

/// S = K_cc + K_cf U and R = K_cf W - L_c of degree p, every unit displacement and friction case solved by a sparse
/// factor of all free unknowns.
struct PlainMatrices {
  Eigen::MatrixXd S, R;
};
[[nodiscard]] PlainMatrices plain_matrices(const Eigen::SparseMatrix<double>& K_ff, const Problem& problem, int p);

}  // namespace fastjoint::test
