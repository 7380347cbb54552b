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

/// Waves of a rim of contact of higher order than those of the finite elements, in closed form (docs/theory.md,
/// section 6.3).
///
/// p are the waves of the pressure on the sheet, tau those of its shear, w those of the disc's normal displacement
/// relative to the sheet; L are the long waves, which the elements represent, S the short ones. In the joint the rim of
/// the sheet has no springs, and its short waves of w are fixed at zero; with delta its long waves,
///   w_L = delta - (M p)_L - (M_tau tau)_L,   w_S = -(M p)_S - (M_tau tau)_S.
/// In the finite elements the rim has springs K, which also resist the short waves; there the long waves are
///   d = w_L + G^T (p - K w)_S + E tau_S,   and   delta = d + C_fixed p_L + R_fixed tau_L.
/// In an isotropic sheet waves of different order are uncoupled: delta = d = w_L.
///
/// An elastic disk in place of the springs adds the compliance of its rim to M and M_tau; w is then the displacement
/// of the rim of the disk relative to that of the sheet.
struct ShortWaves {
  Index n_long = 0, n = 0;                ///< pressure waves of the elements, and all
  Index n_long_shears = 0, n_shears = 0;  ///< the same for shear
  MatrixXd
      D;  ///< (n + n_shears)^2 displacements of an infinite sheet by tractions, length / stress; empty: no short waves
  MatrixXd G, G_t, E;         ///< length / stress; short waves in the elements are -(G p_L + G_t tau_L)
  MatrixXd C_fixed, R_fixed;  ///< (n_long, n_long), (n_long, n_long_shears) length / stress
  MatrixXd M, M_tau;          ///< (n, n) positive semi-definite, (n, n_shears) length / stress
  VectorXd disk_compliance;   ///< (n) of an elastic disk by pressure, length / stress; empty: springs are in its place
  MatrixXd disk_by_shear;     ///< (n, n_shears) length / stress
  VectorXd disk_tangential;   ///< (n_shears) of the disk along shears, length / stress
  double min_compliance = 0;  ///< minimum for sheet and disk over waves of order 2 and more, length / stress

  [[nodiscard]] bool is_empty() const { return D.size() == 0 || n == n_long; }
  /// Number of pressure and shear waves of the elements.
  [[nodiscard]] Index n_carried() const { return n_long + n_long_shears; }
};
[[nodiscard]] ShortWaves short_waves(const formats::ContactRim& contact, const formats::WaveRim& carried);

/// The short waves of all rims of contact of a plate; equal rims have one object in common.
[[nodiscard]] std::vector<std::shared_ptr<const ShortWaves>> short_waves_of(const formats::PlateMatrices& a);

/// Rows and columns of a plate's matrices for the waves of its rims of contact in the elements: with F the pressure
/// waves in excess of the springs' pressure (stress times area), tau the shear waves (stress), and d the means of the
/// disc's normal displacement in the same waves,
///   P = S u + B^T F + R tau + ...,   d = B u - C F + R_p tau + R_f Lambda + T f.
struct RimMatrices {
  MatrixXd B;    ///< (k, discs + externals) dimensionless
  MatrixXd C;    ///< (k, k) length / force
  MatrixXd R;    ///< (discs + externals, shears) length^2
  MatrixXd R_p;  ///< (k, shears) length / stress
  MatrixXd R_f;  ///< (k, h) by the friction cases of other holes, length / stress
  MatrixXd T;    ///< (k, q) length / force
};
/// @param level Index among the file's degrees.
[[nodiscard]] RimMatrices rim_matrices(const formats::PlateMatrices& a, Index level);

}  // namespace fastjoint::stage3
