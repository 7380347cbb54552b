// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/formats/header.hpp"
#include "common/formats/plate_stresses.hpp"

namespace fastjoint::formats {

/// Highest degree of matrices: they may come from elsewhere than stage 2.
inline constexpr int highest_degree = 99;

/// A hole whose springs push but do not pull: where they do, under the loads of PLATE.json.
struct HoleContact {
  std::string hole;
  std::vector<std::array<double, 2>> arcs;  ///< from, to, degrees counter-clockwise from x
  int iterations;                           ///< until the arcs stood still
  double peak_pressure;                     ///< stress
  double peak_angle;                        ///< where, degrees
};

/// Everything linear about one sheet, for every degree p (schemas/plate-matrices.md).
///
/// np degrees, e rigid externals, m discs (hole x direction), h friction cases (hole, direction, bearing + then -),
/// q tractions. Forces are those that must act on the sheet from outside:
///   (P, F) = S (D_e, D) + R Lambda + T f.
struct PlateMatrices {
  Header header;
  std::string plate_digest{};                          ///< of the PLATE.h5 that these are of; empty if it has none
  pfem::Space space = pfem::Space::trunk;              ///< of a sheet of finite elements
  Eigen::VectorXi p, ndof;                             ///< (np)
  std::vector<std::string> disc_hole, disc_direction;  ///< (m)
  /// (m) modulus of the distributed springs between disc and sheet, which hold the bearing of the sheet; 0 where the
  /// file does not say, force / length^3.
  Eigen::VectorXd disc_modulus;
  std::vector<std::string> external_id, external_direction;  ///< (e); "x" or "y"
  std::vector<std::string> traction_id, traction_direction;  ///< (q)
  std::vector<std::string> friction_hole, friction_bearing;  ///< (h); bearing is "+x", "-x", "+y", "-y"
  Eigen::VectorXd friction_unit_force;  ///< (h) c: bearing force per unit peak contact stress, length^2
  Eigen::VectorXd friction_resultant;   ///< (h) resultant along the direction of a unit case, signed, length^2
  std::vector<Eigen::MatrixXd> S_ee, S_ed, S_dd;  ///< np x (e,e), (e,m), (m,m), force / length
  std::vector<Eigen::MatrixXd> R_ef, R_df;        ///< np x (e,h), (m,h), length^2
  std::vector<Eigen::MatrixXd> T_d, T_e;          ///< np x (m,q), (e,q), dimensionless
  std::vector<Eigen::MatrixXd> C_t;               ///< np x (q,q), length / force
  /// Estimated absolute error at the highest p; infinite where one p alone says nothing of it.
  Eigen::MatrixXd S_ee_error, S_ed_error, S_dd_error;
  PlateStresses stresses;
  std::vector<HoleContact> contacts;  ///< under the scene's loads
  /// The scene's loads as amounts of the unit cases, one row if it has loads, else none.
  Eigen::MatrixXd load_displacement;  ///< (l, e + m) length
  Eigen::MatrixXd load_friction;      ///< (l, h) stress
  Eigen::MatrixXd load_traction;      ///< (l, q) force

  [[nodiscard]] Eigen::Index n_externals() const { return external_id.size(); }
  [[nodiscard]] Eigen::Index n_discs() const { return disc_hole.size(); }
  [[nodiscard]] Eigen::Index n_friction_cases() const { return friction_hole.size(); }
  [[nodiscard]] Eigen::Index n_tractions() const { return traction_id.size(); }
  /// Unit cases in their order: externals, discs, friction, tractions.
  [[nodiscard]] Eigen::Index n_cases() const { return n_externals() + n_discs() + n_friction_cases() + n_tractions(); }
};

/// Returns the digest of the file. Throws FileError; what was at `path` before survives.
std::string write(const std::string& path, const PlateMatrices& matrices);

/// Reads all of it but contacts and loads, which nothing behind stage 2 needs. `p`, `disc/hole`, `disc/direction` and
/// `S_dd` must stand in the file; groups that a hand-made file leaves out (external, friction, traction, errors) are
/// taken as empty, directions of externals as x.
[[nodiscard]] PlateMatrices read_plate_matrices(const std::string& path);

}  // namespace fastjoint::formats
