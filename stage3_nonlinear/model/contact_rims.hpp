// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <mutex>
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
/// The compliance of an elastic disk, or of the springs, is in M and M_tau too; w is then the displacement of the rim
/// of the disk relative to that of the sheet. All waves beyond the shortest have the compliance `tail` (section 6.8),
/// which in the long waves is more than that of the springs: what is missing is `moved` from the sheet into M.
struct ShortWaves {
  rim::Harmonics pressures{1};            ///< all
  Index n_long = 0, n = 0;                ///< pressure waves of the elements, and all
  Index n_long_shears = 0, n_shears = 0;  ///< the same for shear
  MatrixXd
      D;  ///< (n + n_shears)^2 displacements of an infinite sheet by tractions, length / stress; empty: no closed form
  MatrixXd G, G_t, E;         ///< length / stress; short waves in the elements are -(G p_L + G_t tau_L)
  MatrixXd C_fixed, R_fixed;  ///< (n_long, n_long), (n_long, n_long_shears) length / stress
  MatrixXd M, M_tau;          ///< (n, n) positive semi-definite, (n, n_shears) length / stress
  VectorXd disk_compliance;   ///< (n) of disk or springs by pressure, length / stress
  MatrixXd disk_by_shear;     ///< (n, n_shears) length / stress
  VectorXd disk_tangential;   ///< (n_shears) of the disk along shears, length / stress
  double fall = 0;            ///< compliance of a wave times its order, without that of springs, length / stress
  double tail = 0;            ///< length / stress
  VectorXd part;              ///< (n) of its compliance that M has of each wave
  VectorXd moved;             ///< (n_long) length / stress

  [[nodiscard]] bool is_empty() const { return D.size() == 0 || n == n_long; }
  /// Number of pressure and shear waves of the elements.
  [[nodiscard]] Index n_carried() const { return n_long + n_long_shears; }
};

/// The waves of a rim up to as many as a joint asks for.
class ContactWaves {
 public:
  /// @param moves False in a sheet that has no compliance to spare: the springs between the rims are stiffer then.
  ContactWaves(const formats::ContactRim& contact, const formats::WaveRim& carried, bool moves = true);

  /// True if another rim has the same waves.
  [[nodiscard]] bool is_of(const formats::ContactRim& contact, const formats::WaveRim& carried) const;
  /// Highest order of the waves that contact asks for, a multiple of 4 if the file does not say it: the narrower the
  /// arc on which a disc with a gap touches, the more waves (docs/theory.md, section 6.8).
  /// @param force Largest force of a fastener.
  [[nodiscard]] int order(double gap, double force) const;
  /// Order of the waves that show the error of peaks by those up to `order`: half as many, or twice as many where the
  /// stress converges slowly.
  [[nodiscard]] int order_to_compare(int order, double mu) const;
  /// Those of all orders up to one, for the sheet's matrices with the fewest. They are kept, for any thread.
  [[nodiscard]] std::shared_ptr<const ShortWaves> up_to(int order) const;
  /// Those to which the sheet's matrices belong, the fewest that a joint asks for.
  [[nodiscard]] const ShortWaves& fewest() const { return *fewest_; }
  /// True with friction on an elastic disk, or on springs that the shortest wave does not feel: the stress is like a
  /// square root at the end of contact, for which waves converge slowly.
  [[nodiscard]] bool has_root_at_end(double mu) const { return mu > 0 && is_stiff(); }

 private:
  [[nodiscard]] bool is_stiff() const;
  formats::ContactRim contact_;
  formats::WaveRim carried_;
  std::shared_ptr<const ShortWaves> fewest_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::shared_ptr<const ShortWaves>> kept_;
};

/// The waves of all rims of contact of a plate; equal rims have one object in common.
[[nodiscard]] std::vector<std::shared_ptr<const ContactWaves>> contact_waves_of(const formats::PlateMatrices& a,
                                                                                bool moves = true);

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
