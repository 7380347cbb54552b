// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/formats/plate_matrices.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Waves of a rim of contact that the finite elements do not carry, in closed form (docs/theory.md, section 6.3).
///
/// p are the waves of the pressure on the sheet, tau those of its shear, w those of the disc's normal displacement
/// against the sheet. The elements' sheet has springs K at the rim that also resist the short waves of w; what these do
/// is taken out again: with L the long and s the short waves, and the infinite sheet's compliance D,
///   w_s = -G p_L - C q_s - G_t tau_L - C_t tau_s,   q_s = p_s - K w_s,
///   w_L = w_L of the elements - G^T q_s - E tau_s.
struct ShortWaves {
  Index n_long, n;                ///< pressures that the elements carry, and all
  Index n_long_shears, n_shears;  ///< shears likewise
  MatrixXd D;  ///< (n + n_shears)^2 displacements by tractions, length / stress; empty: no short waves
  // Waves of twice the order that the joint solves for, which the joint's own leave out: what tractions do to the
  // normal displacements beyond n, (n_beyond, all pressures and shears), length / stress.
  rim::Harmonics wider;
  MatrixXd D_beyond;
  MatrixXd G, C, G_t, C_t, E;  ///< length / stress

  [[nodiscard]] bool is_empty() const { return D.size() == 0 || n == n_long; }
  /// Pressures and shears that the elements carry.
  [[nodiscard]] Index n_carried() const { return n_long + n_long_shears; }
};
[[nodiscard]] ShortWaves short_waves(const formats::ContactRim& contact, const formats::WaveRim& carried);

/// What rims of contact add to a plate's matrices: with forces F on all their waves of pressure (stress times area),
/// amounts tau of those of shear (stress), and the means m of the disc's normal displacement in the same waves,
///   P = S u + B^T F + R tau + ...,   m = B u - C F + R_p tau + R_f Lambda + T f.
struct RimMatrices {
  MatrixXd B;    ///< (k, discs + externals) dimensionless
  MatrixXd C;    ///< (k, k) length / force
  MatrixXd R;    ///< (discs + externals, shears) length^2
  MatrixXd R_p;  ///< (k, shears) length / stress
  MatrixXd R_f;  ///< (k, h) by friction cases of other holes, length / stress
  MatrixXd T;    ///< (k, q) length / force
};
/// @param level Of the file's degrees.
[[nodiscard]] RimMatrices rim_matrices(const formats::PlateMatrices& a, Index level);

}  // namespace fastjoint::stage3
