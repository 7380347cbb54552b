// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"
#include "stage1_plate/problem/elements.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// A spring between a degree of freedom of a vertex and a controlled displacement.
struct PointTie {
  int vertex, dof, controlled;
  double stiffness;  ///< force / length
};

/// The discrete plate at the highest p: n_f free unknowns (by degree), nc controlled ones, h friction cases, q
/// tractions. Its stiffness K_ff among the free unknowns is never assembled: it is there element by element
/// (PlateFactor).
struct PlateProblem {
  pfem::Numbering numbering;
  Unknowns unknowns;
  PlateElements elements;
  /// Springs between vertices of the mesh and discs of their own, section 3.1 of the paper: the displacement of the
  /// vertex, and with it the springs' load, does not converge.
  std::vector<PointTie> ties;
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc), force / length
  Eigen::MatrixXd K_cc;              ///< (nc, nc)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::SparseMatrix<double> L_f;  ///< (n_f, h) loads of the unit friction cases on the plate, length^2
  Eigen::MatrixXd L_c;              ///< (nc, h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force, uniformly spread
  Eigen::MatrixXd T_c;              ///< (nc, q)
};

/// The problem with its unknowns, elements and cases, at the scene's highest p, and nothing integrated. Throws
/// InputError where supports or externals contradict each other, or hold the vertex of a point spring.
[[nodiscard]] PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate);
/// Integrates elements, springs and loads, each congruence class once.
/// Throws InputError for an arc that the rim of the model does not have, and for a load that loads nothing.
void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);
/// Numbers and integrates.
[[nodiscard]] PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
