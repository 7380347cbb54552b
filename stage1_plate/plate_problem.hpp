// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "stage1_plate/plate_mesh.hpp"
#include "stage1_plate/unknowns.hpp"

namespace fastjoint::stage1 {

/// The discrete plate at the highest p, with rows for the n_f free unknowns (by degree) and the nc controlled ones.
struct PlateProblem {
  pfem::Numbering numbering;
  Unknowns unknowns;
  Eigen::SparseMatrix<double> K_ff;  ///< lower triangle, (n_f, n_f), force / length
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc)
  Eigen::MatrixXd K_cc;              ///< (nc, nc)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::SparseMatrix<double> L_f;  ///< (n_f, h) loads of the unit friction cases on the plate, length^2
  Eigen::MatrixXd L_c;              ///< (nc, h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force, uniformly spread
  Eigen::MatrixXd T_c;              ///< (nc, q)
};

/// Integrates elements, springs and loads once, at the scene's highest p.
[[nodiscard]] PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
