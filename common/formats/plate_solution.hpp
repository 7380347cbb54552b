// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "common/formats/header.hpp"
#include "common/pfem/mesh.hpp"
#include "common/pfem/rim.hpp"

namespace fastjoint::formats {

/// Solutions of one degree p, with all controlled displacements (rigid externals, then discs) held but one.
struct PlateCases {
  Eigen::MatrixXd U;      ///< (n_p, nc) plate unknowns per unit of each controlled displacement
  Eigen::MatrixXd V;      ///< (n_p, q) plate unknowns per unit total force on each traction boundary
  Eigen::VectorXd probe;  ///< (n_p) under the friction loads weighted by friction_probe: checks reciprocity
};

/// What stage 1 hands to stage 2 (schemas/plate-solution.md).
///
/// nc = e + m controlled displacements: e rigid externals, then m discs; h friction cases; q tractions. Unknowns are
/// ordered by degree: the rows of the couplings and loads for degree p are the first ndof(p).
struct PlateSolution {
  Header header;
  pfem::Mesh mesh;  ///< without materials
  std::vector<std::string> hole_id;
  std::vector<pfem::Rim> hole_rim;
  std::vector<std::string> supported;  ///< directions that a support fixes somewhere
  Eigen::VectorXi p, ndof;
  std::vector<std::string> external_id, external_direction;
  std::vector<std::string> traction_id, traction_direction;
  std::vector<std::string> disc_hole, disc_direction;
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc), force / length
  Eigen::MatrixXd K_cc;              ///< (nc, nc), force / length
  Eigen::SparseMatrix<double> L_f;   ///< (n_f, h) loads of the unit friction cases, length^2
  Eigen::MatrixXd L_c;               ///< (nc, h) what of them acts on the controlled displacements directly
  Eigen::SparseMatrix<double> T_f;   ///< (n_f, q) loads of the unit tractions
  Eigen::MatrixXd T_c;               ///< (nc, q)
  Eigen::VectorXd friction_probe;    ///< (h) weights of the probe case
  std::vector<PlateCases> cases;     ///< one for each p
};

/// Throws FileError; what was at `path` before survives.
void write(const std::string& path, const PlateSolution& solution);
[[nodiscard]] PlateSolution read_plate_solution(const std::string& path);

}  // namespace fastjoint::formats
