// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"
#include "stage1_plate/problem/elements.hpp"
#include "stage1_plate/problem/line_springs.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// The discrete plate at the highest p: n_f free unknowns (by degree), nc controlled ones, h friction cases, q
/// tractions. Its stiffness K_ff among the free unknowns is never assembled: it is there element by element
/// (PlateFactor).
struct PlateProblem {
  pfem::Numbering numbering;
  Unknowns unknowns;
  PlateElements elements;
  std::vector<PointTie> ties;
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc), force / length
  Eigen::MatrixXd K_cc;              ///< (nc, nc)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::SparseMatrix<double> L_f;  ///< (n_f, h) loads of the unit friction cases on the plate, length^2
  Eigen::MatrixXd L_c;              ///< (nc, h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force, uniformly spread
  Eigen::MatrixXd T_c;              ///< (nc, q)
};

/// The problem with its unknowns, elements and cases, at the scene's highest p, and nothing integrated.
[[nodiscard]] PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate);
/// Integrates elements, springs and loads, each shape once.
/// Throws InputError for an arc that the rim of the model does not have.
void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);
/// Both.
[[nodiscard]] PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
