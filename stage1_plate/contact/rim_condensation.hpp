// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/contact/rim_gap.hpp"

namespace fastjoint::stage1 {

/// The plate condensed to its rim unknowns r and its controlled displacements c (docs/theory.md, section 6.2). Under
/// displacements D, tractions f, friction amplitudes Lambda and additional loads phi on r:
/// u_r = U_r D + V_r f + W_r Lambda + C phi,  P_c = S D + R Lambda + T f - U_r^T phi.
struct RimCondensation {
  Eigen::MatrixXd C;    ///< (n_r, n_r) length / force
  Eigen::MatrixXd U_r;  ///< (n_r, nc)
  Eigen::MatrixXd V_r;  ///< (n_r, q) length / force
  Eigen::MatrixXd W_r;  ///< (n_r, h) length / stress
  Eigen::MatrixXd S;    ///< (nc, nc) force / length
  Eigen::MatrixXd T;    ///< (nc, q)
  Eigen::MatrixXd R;    ///< (nc, h) length^2
};

/// One factorisation at the highest degree, n_r + q + nc + h right-hand sides.
[[nodiscard]] RimCondensation condense_to_rims(const PlateProblem& problem, const RimUnknowns& rim);

}  // namespace fastjoint::stage1
