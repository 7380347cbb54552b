// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Large matrices have the row-major layout of the file, which saves a copy.
using StressRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Data of the stresses at holes per unit case at l degrees (schemas/plate-matrices.md). A plate from another source
/// has none: l = 0.
///
/// The n_cases unit cases are the e rigid externals (per length), m discs (per length), k loaded waves and h friction
/// cases (per stress), q tractions (per force); r holes; s sections.
struct PlateStresses {
  Eigen::VectorXi p;                  ///< (l) ascending: the n_stress_degrees highest degrees, or all
  std::vector<std::string> rim_hole;  ///< (r)
  Eigen::MatrixXd rim_center;         ///< (r, 2) length
  Eigen::VectorXd rim_radius;         ///< (r) length
  Eigen::VectorXd rim_thickness;      ///< (r) mean thickness of the plate there, length; 0 if not given
  Eigen::MatrixXd rim_modulus;        ///< (r, 2) mean modulus in tension along x, along y, stress; 0 if not given
  Eigen::MatrixXd bearing_area;       ///< (r, 2) for bearing along x and along y, d t for a whole hole, length^2
  /// l x (w - k, n_cases) as PlateMatrices::W, for the waves without tractions
  std::vector<StressRows> other_waves;
  std::vector<std::string> section_hole, section_side;  ///< (s)
  Eigen::VectorXd gross_area, net_area;                 ///< (s) length^2
  std::vector<StressRows> section_force;                ///< l x (s, n_cases), tension positive
  std::vector<StressRows> section_shear{};              ///< l x (s, n_cases), as the stress xy; infinite: not known
  /// (l) estimated relative error of S and C_t, 0 if not given; that of a section's force is up to its square root
  Eigen::VectorXd stiffness_error;
};

/// The t tips of cracks with their stress intensity factors in each unit case.
struct CrackRows {
  std::vector<pfem::CrackTip> tips;   ///< (t) without their elements
  std::vector<StressRows> K_I, K_II;  ///< n_p x (t, n_cases), stress length^1/2 per unit of the case
};

/// Properties of a plate other than its condensed matrices.
struct PlateProperties : UnitCases {
  std::string plate_digest{};  ///< digest of the PLATE.h5 that these were extracted from; empty if it has none
  /// Directions, "x" or "y", along which the plate has no support, so that the forces on it are in balance; empty if
  /// not given.
  std::vector<std::string> unsupported{};
  /// (m) modulus of the distributed springs between disc and plate, which include the bearing flexibility of the plate;
  /// 0 if not given, force / length^3
  Eigen::VectorXd disc_modulus;
  Eigen::VectorXd friction_unit_force;  ///< (h) c: bearing force per unit peak contact stress, length^2
  Eigen::VectorXd friction_resultant;   ///< (h) signed resultant of a unit case along its direction, length^2
  /// (h), (q) resultants along + the other axis of a unit friction case, length^2, and of a unit total force on each
  /// traction boundary, dimensionless; an empty vector means zeros
  Eigen::VectorXd friction_resultant_across, traction_resultant_across;
  Eigen::VectorXd
      traction_unit_force;  ///< (q) force per unit peak of the cosine pressure in a hole, length^2; 0 for edges
  PlateStresses stresses;
  CrackRows cracks{};
};

/// The condensed linear model of one plate for every degree p (schemas/plate-matrices.md).
///
/// Forces are those of the surroundings on the plate:
///   (P, F) = S (D_e, D) + R Lambda + T f.
struct PlateMatrices : PlateProperties {
  std::vector<Eigen::MatrixXd> S_ee, S_ed, S_dd;  ///< n_p x (e,e), (e,m), (m,m), force / length
  std::vector<Eigen::MatrixXd> R_ef, R_df;        ///< n_p x (e,h), (m,h), length^2
  std::vector<Eigen::MatrixXd> T_d, T_e;          ///< n_p x (m,q), (e,q), dimensionless
  std::vector<Eigen::MatrixXd> C_t;               ///< n_p x (q,q), length / force
  /// n_p x (k, n_cases) PlateCases::W of the loaded waves: their integrals in each unit case. The transposed columns of
  /// externals and discs are the forces on these by each loaded wave.
  std::vector<StressRows> W;
  /// Estimated absolute error at the highest p; infinite for a single p.
  Eigen::MatrixXd S_ee_error, S_ed_error, S_dd_error;
};

/// Returns the digest of the file. Throws FileError; an existing file at `path` is then kept.
std::string write(const std::string& path, const PlateMatrices& matrices);

/// Reads the file. `p`, `disc/hole`, `disc/direction` and `S_dd` are required; groups that a hand-made file omits
/// (external, friction, traction, errors) are empty, and omitted directions of externals are x.
[[nodiscard]] PlateMatrices read_plate_matrices(const std::string& path);

/// The same without the matrices, which may be large.
[[nodiscard]] UnitCases read_unit_cases(const std::string& path);

}  // namespace fastjoint::formats
