// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace fastjoint::formats {

/// Stresses of one sheet per unit case, at l degrees (schemas/plate-matrices.md). A sheet from elsewhere has none: l =
/// 0.
///
/// The n_cases unit cases are the e rigid externals (per length), m discs (per length), h friction cases (per stress),
/// q tractions (per force); r rims of holes with k points in all; s sections.
struct PlateStresses {
  Eigen::VectorXi p;                  ///< (l) ascending; all of them if no more than two, else the two highest
  std::vector<std::string> rim_hole;  ///< (r)
  Eigen::MatrixXd rim_center;         ///< (r, 2) length
  Eigen::VectorXd rim_radius;         ///< (r) length
  Eigen::VectorXd rim_thickness;      ///< (r) mean thickness of the sheet there, length; 0 where the file does not say
  Eigen::MatrixXd rim_modulus;        ///< (r, 2) mean modulus in tension along x, along y, stress; 0 likewise
  Eigen::MatrixXd bearing_area;       ///< (r, 2) d t of a whole hole, for bearing along x and along y, length^2
  /// (r + 1) first point of each rim
  Eigen::VectorXi rim_start = Eigen::VectorXi::Zero(1);
  Eigen::VectorXd angle;                                      ///< (k) of each point, degrees counter-clockwise from x
  std::vector<Eigen::MatrixXd> sigma_rr, sigma_tt, sigma_rt;  ///< l x (k, n_cases)
  std::vector<std::string> section_hole, section_side;        ///< (s)
  Eigen::VectorXd gross_area, net_area;                       ///< (s) length^2
  std::vector<Eigen::MatrixXd> section_force;                 ///< l x (s, n_cases), tension positive
};

}  // namespace fastjoint::formats
