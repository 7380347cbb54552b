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

/// A unit load on an external that is not rigid. A load in a hole bears on the side that it points to, so a positive
/// and a negative force are separate cases.
struct TractionCase {
  int external;  ///< index into PlateScene::externals
  int side = 0;  ///< 1 or -1: bearing half of the hole, along or against the direction; 0 on an edge or of a moment
  /// Force per unit peak of the cosine pressure on that half of the rim, length^2; 0 if the model has no rim there.
  double unit_force = 0;
};

/// An edge, weighted with its thickness.
struct EdgeMoments {
  double area = 0;                                     ///< length^2
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();  ///< (2)
  double arm = 0;                                      ///< radius of gyration about the centroid, length
};
[[nodiscard]] EdgeMoments edge_moments(const PlateMesh& plate, const std::string& edge);

/// The discrete plate at the highest p: n_f free unknowns (by degree), nc controlled ones, h friction cases, q
/// tractions. Stiffness and loads of the rims are stored by class of elements.
struct PlateProblem : plate::PlateStiffness {
  /// (q) in the order of the externals. A hole has a case against its direction only if the model has a rim there.
  std::vector<TractionCase> tractions;
  std::vector<std::optional<rim::Waves>> waves;              ///< (holes) of rim_waves
  std::vector<std::string> friction_hole, friction_bearing;  ///< (h)
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of a unit total force on each traction; empty until integrated
  Eigen::MatrixXd T_c;              ///< (nc, q) part of these loads on the controlled displacements
};

/// Entries of a load matrix: n_f rows for the free unknowns, then nc for the controlled displacements.
using Loads = std::vector<Eigen::Triplet<double>>;

/// Adds the load of one element.
/// @param values Loads on the modes, local signs, first for u_x, then for u_y.
void add_load(const plate::PlateStiffness& plate, int element, const std::vector<int>& modes,
              const Eigen::VectorXd& values, int column, Loads& loads);

/// Waves of every hole's rim that the elements resolve: for contact (loaded) and for stresses. Their order follows from
/// the decay of the fields reflected by edges and other holes (docs/theory.md, section 11.3).
/// Throws InputError if a rim of contact is in several pieces or of several thicknesses.
[[nodiscard]] std::vector<std::optional<rim::Waves>> rim_waves(const PlateScene& scene, const PlateMesh& plate);
/// Strains of the sheet at a hole's rim per unit stress; zero without a closed form (formats::WaveRim).
[[nodiscard]] Eigen::Matrix3d rim_compliance(const PlateScene& scene, const PlateMesh& plate, int hole);
/// True if the rim is whole or ends on lines of symmetry.
[[nodiscard]] bool ends_on_symmetry(const PlateScene& scene, const PlateMesh& plate, int hole);

/// The mesh with the scene's springs and waves.
[[nodiscard]] plate::SprungMesh sprung_mesh(const PlateScene& scene, const PlateMesh& plate);

/// Sets up unknowns, elements and cases at the scene's highest p, without integration. Throws InputError if supports or
/// externals contradict each other, or fix the vertex of a point spring.
[[nodiscard]] PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate);
/// Integrates elements, springs and loads, each congruence class once.
/// Throws InputError for an arc outside the rim in the model, and for a load without effect.
void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem);

/// Force along x and y, and moment about a place, of every unit load of a sheet, (3, tractions).
[[nodiscard]] Eigen::Matrix3Xd resultants(const PlateScene& scene, const PlateMesh& plate,
                                          const std::vector<TractionCase>& tractions, const Eigen::Vector2d& place);

/// Warnings of half and quarter holes with springs on lines without a symmetry support, one for each line with the
/// support to add. In such a model the disc alone carries the load of the missing part.
[[nodiscard]] std::vector<std::string> missing_symmetry(const PlateScene& scene, const PlateMesh& plate,
                                                        const Unknowns& unknowns);

/// Throws NumericalError if the plate, or a part of it, has a rigid body motion while all externals and discs are
/// fixed. The message describes the motion (docs/theory.md, section 4.7) and missing symmetry supports. The
/// factorisation alone would not detect it.
void check_rigid_motions(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns);

/// Highest order of waves that elements of degree p resolve with this number of sides around a whole hole.
[[nodiscard]] int resolved_order(int p, double n_sides);

/// Highest order of the waves around each hole that the elements must include: fields of higher order reflected by
/// edges, other holes, point springs and steps of thickness or material are negligible, and the closed form holds. A
/// value in the scene takes precedence (docs/theory.md, section 11.3).
[[nodiscard]] std::vector<int> needed_orders(const PlateScene& scene, const PlateMesh& plate);

/// Holes whose order is given in the scene and lower than they need: a line for each.
[[nodiscard]] std::vector<std::string> few_waves(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
