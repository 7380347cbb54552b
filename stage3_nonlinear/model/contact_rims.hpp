// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Waves of a rim of contact that the finite elements do not carry, in closed form (docs/theory.md, section 6.3).
///
/// p are the waves of the pressure on the sheet, tau those of its shear, w those of the disc's normal displacement
/// against the sheet; L are the long waves, which the elements carry, S the short ones. The joint's sheet is one whose
/// rim has no springs and no short waves of w; with delta its long waves,
///   w_L = delta - (M p)_L - (M_tau tau)_L,   w_S = -(M p)_S - (M_tau tau)_S.
/// The elements' sheet has springs K at the rim, which also resist the short waves: its long waves are
///   d = w_L + G^T (p - K w)_S + E tau_S,   and   delta = d + C_held p_L + R_held tau_L.
/// In an isotropic sheet waves of different order are apart: delta = d = w_L.
///
/// An elastic disk that presses in place of the springs adds what its rim yields to M and M_tau, and w of these
/// formulas is less by that: it is the displacement that is left between the two rims.
struct ShortWaves {
  Index n_long = 0, n = 0;                ///< pressures that the elements carry, and all
  Index n_long_shears = 0, n_shears = 0;  ///< shears likewise
  MatrixXd
      D;  ///< (n + n_shears)^2 displacements of an infinite sheet by tractions, length / stress; empty: no short waves
  MatrixXd G, G_t, E;       ///< length / stress, G_t and G times K what the elements' springs make of short waves
  MatrixXd C_held, R_held;  ///< (n_long, n_long), (n_long, n_long_shears) length / stress
  MatrixXd M, M_tau;        ///< (n, n) positive semi-definite, (n, n_shears) length / stress
  VectorXd yield;           ///< (n) of an elastic disk by pressure, length / stress; empty: springs are in its place
  MatrixXd yield_by_shear;  ///< (n, n_shears) length / stress
  VectorXd give_way;        ///< (n_shears) of the disk along shears, length / stress
  double least_yield = 0;   ///< least of sheet and disk together by any wave of order 2 and more, length / stress

  [[nodiscard]] bool is_empty() const { return D.size() == 0 || n == n_long; }
  /// Pressures and shears that the elements carry.
  [[nodiscard]] Index n_carried() const { return n_long + n_long_shears; }
};
[[nodiscard]] ShortWaves short_waves(const formats::ContactRim& contact, const formats::WaveRim& carried);

/// The short waves of all rims of contact of a plate; equal rims share them.
[[nodiscard]] std::vector<std::shared_ptr<const ShortWaves>> short_waves_of(const formats::PlateMatrices& a);

/// What rims of contact add to a plate's matrices, by the waves that the elements carry: with forces F on those of
/// pressure that are added to what the springs bear (stress times area), amounts tau of those of shear (stress), and
/// the means d of the disc's normal displacement in the same waves,
///   P = S u + B^T F + R tau + ...,   d = B u - C F + R_p tau + R_f Lambda + T f.
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
