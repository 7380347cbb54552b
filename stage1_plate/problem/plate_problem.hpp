// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "common/plate/plate_stiffness.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

using plate::Unknowns;

/// Indices of the rigid externals into PlateScene::externals.
[[nodiscard]] std::vector<int> rigid_externals(const PlateScene& scene);

/// A unit load on an external that is not rigid. A load in a hole bears on the side that it points to: a positive force
/// on one, a negative force on the other, each its own case.
struct TractionCase {
  int external;  ///< index into PlateScene::externals
  int side;      ///< 1 or -1: the half of the hole along its direction or against it bears; 0 on an edge
};

/// The loads in the order of the externals. A hole has the side against its direction if the model has rim there.
[[nodiscard]] std::vector<TractionCase> traction_cases(const PlateScene& scene, const PlateMesh& plate);

/// First disc of a point spring: the discs of these are the last.
[[nodiscard]] int disc_of_point(const PlateScene& scene, const Unknowns& unknowns, int point);

/// Applies supports and rigid externals. Throws InputError where two of them want the same displacement.
[[nodiscard]] Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate,
                                         const pfem::Numbering& numbering);

/// The discrete plate at the highest p: n_f free unknowns (by degree), nc controlled ones, h friction cases, q
/// tractions. Its stiffness, and with it what the cases load, is there element by element.
struct PlateProblem : plate::PlateStiffness {
  std::vector<std::string> friction_hole, friction_bearing;  ///< (h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force, uniformly spread; 0 until integrated
  Eigen::MatrixXd T_c;              ///< (nc, q) what of them acts on the controlled displacements directly
};

/// Entries of columns of loads: n_f rows of the free unknowns, then nc of the controlled displacements.
using Loads = std::vector<Eigen::Triplet<double>>;

/// Adds the load of one element.
/// @param values Over modes of the element, local signs, first those of u_x, then those of u_y.
void add_load(const plate::PlateStiffness& plate, int element, const std::vector<int>& modes,
              const Eigen::VectorXd& values, int column, Loads& loads);

/// Waves of every hole's rim that the elements carry: those of contact, loaded, and those of which stresses are asked.
/// The order follows from how fast what edges and other holes send back falls (docs/theory.md, section 11.3).
/// Throws InputError if a rim of contact is in several pieces or of several thicknesses.
[[nodiscard]] std::vector<std::optional<rim::Waves>> rim_waves(const PlateScene& scene, const PlateMesh& plate);
/// Strains of the sheet at a hole's rim by its stresses; zero where no closed form holds, as formats::WaveRim says.
[[nodiscard]] Eigen::Matrix3d rim_compliance(const PlateScene& scene, const PlateMesh& plate, int hole);
/// True if the rim is whole, or its ends lie on lines of symmetry.
[[nodiscard]] bool ends_on_symmetry(const PlateScene& scene, const PlateMesh& plate, int hole);

/// The mesh with the scene's springs and waves.
[[nodiscard]] plate::SprungMesh sprung_mesh(const PlateScene& scene, const PlateMesh& plate);

/// The problem with its unknowns, elements and cases, at the scene's highest p, and nothing integrated. Throws
/// InputError where supports or externals contradict each other, or hold the vertex of a point spring.
[[nodiscard]] PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate);
/// Integrates elements, springs and loads, each congruence class once.
/// Throws InputError for an arc that the rim of the model does not have, and for a load that loads nothing.
void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);

/// Warnings of sprung half and quarter holes on lines that no support makes lines of symmetry, one for each line: their
/// discs stand in for what is missing. Each says which support to add.
[[nodiscard]] std::vector<std::string> missing_symmetry(const PlateScene& scene, const PlateMesh& plate,
                                                        const Unknowns& unknowns);

/// Throws NumericalError if the plate, or a part of it, could move as a rigid body while all externals and discs are
/// held; the message says how (docs/theory.md, section 4.6), and what is missing on lines of symmetry. The factor alone
/// would not show it.
void check_held(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns);

}  // namespace fastjoint::stage1
