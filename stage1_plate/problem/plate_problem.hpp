// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "common/plate/stiffness.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// The discrete plate at the highest p: n_f free unknowns (by degree), nc controlled ones, h friction cases, q
/// tractions. Its stiffness K_ff among the free unknowns is there element by element.
struct PlateProblem : plate::PlateStiffness {
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc), force / length
  Eigen::MatrixXd K_cc;              ///< (nc, nc)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::SparseMatrix<double> L_f;  ///< (n_f, h) loads of the unit friction cases on the plate, length^2
  Eigen::MatrixXd L_c;              ///< (nc, h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force, uniformly spread
  Eigen::MatrixXd T_c;              ///< (nc, q)
  int n_tractions = 0;              ///< q, known before T_f is integrated
};

/// The mesh with the scene's springs.
[[nodiscard]] plate::SprungMesh sprung_mesh(const PlateScene& scene, const PlateMesh& plate);

/// Artificial stiffness of each controlled displacement, shape (nc), force / length: as much as its diagonal entry of
/// K_cc. It keeps the factor of a floating sheet regular and is subtracted from S again (docs/theory.md, section 4.5).
[[nodiscard]] Eigen::VectorXd shift(const PlateProblem& problem);
/// What the border has on its diagonal beside discs and ties, shape (nc + h): the shift, then of each friction case
/// enough for a factor.
[[nodiscard]] Eigen::VectorXd border_diagonal(const PlateProblem& problem);

/// The problem with its unknowns, elements and cases, at the scene's highest p, and nothing integrated. Throws
/// InputError where supports or externals contradict each other, or hold the vertex of a point spring.
[[nodiscard]] PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate);
/// Integrates elements, springs and loads, each congruence class once.
/// Throws InputError for an arc that the rim of the model does not have, and for a load that loads nothing.
void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);
/// Numbers and integrates.
[[nodiscard]] PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
