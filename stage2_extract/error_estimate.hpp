// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fastjoint::stage2 {

/// Estimated absolute error of the last of a sequence of condensed stiffness matrices of rising p, shape (nc, nc).
///
/// A diagonal entry is an energy and falls monotonically: three successive degrees fit S(p) = S_inf + C N^(-2 beta)
/// (Szabo & Babuska 1991, section 4.4). Where they do not (not yet, or rounding), and with two degrees, it is the last
/// difference; with one degree it is infinite. Off the diagonal, the error is the energy product of two errors: |e_ij|
/// <= sqrt(e_ii e_jj).
/// @param N Unknowns of each degree, rising, shape (np).
[[nodiscard]] Eigen::MatrixXd estimate_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& N);

/// The same for one monotone sequence.
[[nodiscard]] double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& N);

}  // namespace fastjoint::stage2
