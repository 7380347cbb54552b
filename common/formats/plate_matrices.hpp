// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Rows lie in memory as they do in the file, since they may be large.
using StressRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What stresses at holes follow from, per unit case, at l degrees (schemas/plate-matrices.md). A plate from elsewhere
/// has none: l = 0.
///
/// The n_cases unit cases are the e rigid externals (per length), m discs (per length), k loaded waves and h friction
/// cases (per stress), q tractions (per force); r holes; s sections.
struct PlateStresses {
  Eigen::VectorXi p;                  ///< (l) ascending; all of them if no more than two, else the two highest
  std::vector<std::string> rim_hole;  ///< (r)
  Eigen::MatrixXd rim_center;         ///< (r, 2) length
  Eigen::VectorXd rim_radius;         ///< (r) length
  Eigen::VectorXd rim_thickness;      ///< (r) mean thickness of the plate there, length; 0 where the file does not say
  Eigen::MatrixXd rim_modulus;        ///< (r, 2) mean modulus in tension along x, along y, stress; 0 likewise
  Eigen::MatrixXd bearing_area;       ///< (r, 2) d t of a whole hole, for bearing along x and along y, length^2
  /// l x (w - k, n_cases) as PlateMatrices::W: of the waves that nothing loads
  std::vector<StressRows> other_waves;
  std::vector<std::string> section_hole, section_side;  ///< (s)
  Eigen::VectorXd gross_area, net_area;                 ///< (s) length^2
  std::vector<StressRows> section_force;                ///< l x (s, n_cases), tension positive
  /// (l) estimated relative error of S and C_t: that of a section's force is up to its square root; 0 where the file
  /// does not say
  Eigen::VectorXd stiffness_error;
};

/// Highest degree of matrices: they may come from elsewhere than stage 2.
inline constexpr int highest_degree = 99;

/// Everything linear about one plate, for every degree p (schemas/plate-matrices.md).
///
/// Forces are those that must act on the plate from outside:
///   (P, F) = S (D_e, D) + R Lambda + T f.
struct PlateMatrices : UnitCases {
  std::string plate_digest{};  ///< of the PLATE.h5 that these are of; empty if it has none
  /// Directions, "x" or "y", along which no support holds the plate, so that the forces on it are in balance; a file
  /// that does not say names none.
  std::vector<std::string> unsupported{};
  /// (m) modulus of the distributed springs between disc and plate, which hold the bearing of the plate; 0 where the
  /// file does not say, force / length^3.
  Eigen::VectorXd disc_modulus;
  Eigen::VectorXd friction_unit_force;  ///< (h) c: bearing force per unit peak contact stress, length^2
  Eigen::VectorXd friction_resultant;   ///< (h) resultant along the direction of a unit case, signed, length^2
  /// (h), (q) resultants along + the other axis of a unit case, length^2, and of a unit total force on each traction
  /// boundary, dimensionless. Empty in memory: all 0.
  Eigen::VectorXd friction_resultant_across, traction_resultant_across;
  std::vector<Eigen::MatrixXd> S_ee, S_ed, S_dd;  ///< np x (e,e), (e,m), (m,m), force / length
  std::vector<Eigen::MatrixXd> R_ef, R_df;        ///< np x (e,h), (m,h), length^2
  std::vector<Eigen::MatrixXd> T_d, T_e;          ///< np x (m,q), (e,q), dimensionless
  std::vector<Eigen::MatrixXd> C_t;               ///< np x (q,q), length / force
  /// np x (k, n_cases) PlateCases::W of the loaded waves: their integrals by each unit case. Its columns of externals
  /// and discs, turned, are the forces on these by each loaded wave.
  std::vector<StressRows> W;
  Eigen::VectorXd
      traction_unit_force;  ///< (q) force per unit peak of the cosine pressure in a hole, length^2; 0 of edges
  /// Estimated absolute error at the highest p; infinite where one p alone says nothing of it.
  Eigen::MatrixXd S_ee_error, S_ed_error, S_dd_error;
  PlateStresses stresses;
};

/// Returns the digest of the file. Throws FileError; what was at `path` before survives.
std::string write(const std::string& path, const PlateMatrices& matrices);

/// Reads all of it. `p`, `disc/hole`, `disc/direction` and `S_dd` must stand in the file; groups that a hand-made file
/// leaves out (external, friction, traction, errors) are taken as empty, directions of externals as x.
[[nodiscard]] PlateMatrices read_plate_matrices(const std::string& path);

}  // namespace fastjoint::formats
