// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "common/formats/header.hpp"
#include "common/pfem/mesh.hpp"
#include "common/rim/rim.hpp"

namespace fastjoint::formats {

/// Forces in the unit cases of one degree p; all controlled displacements (rigid externals, then discs) are fixed but
/// one (docs/theory.md, section 4). They still contain rounding, which stage 2 checks and balances.
struct PlateCases {
  Eigen::MatrixXd S;    ///< (nc, nc) forces on externals and discs per unit displacement of each, force / length
  Eigen::MatrixXd R;    ///< (nc, h) forces on them in unit friction cases, length^2
  Eigen::MatrixXd T;    ///< (nc, q) forces on them under a unit total force on each traction boundary
  Eigen::MatrixXd C_t;  ///< (q, q) mean displacement of the traction boundaries under these, length / force
  /// (w, n_cases) integrals over rims of the disc's displacement relative to the sheet, normal for pressures and
  /// tangential for shears, times the distribution of each wave, in every unit case: for the k loaded waves, at the
  /// n_stress_degrees highest degrees for all waves. Units are length^2 for externals and discs, length^5 / force for
  /// loaded waves and friction cases, length^3 / force for tractions.
  Eigen::MatrixXd W;
  /// (s, n_cases) normal force over every section, tension positive; no rows below the n_stress_degrees highest degrees
  Eigen::MatrixXd N;
  Eigen::MatrixXd V;  ///< (s, n_cases) shear force over them, positive where the shear stress xy is
  Eigen::MatrixXd K;  ///< (2 t, n_cases) K_I, then K_II of every crack tip
};

/// Two states of the highest degree that are solved separately, to check S, R, T and W.
struct Probe {
  Eigen::VectorXd displacement;     ///< (nc) controlled displacements in the first state, length
  Eigen::VectorXd wave;             ///< (k) amplitudes of the loaded waves in the second, stress
  Eigen::VectorXd friction;         ///< (h) amplitudes of the friction cases in the second, stress
  Eigen::VectorXd force;            ///< (nc) forces on externals and discs in the first
  Eigen::VectorXd friction_force;   ///< (nc) forces on externals and discs in the second
  Eigen::VectorXd moment;           ///< (w) integral of each wave's distribution in the first, length^3
  Eigen::VectorXd friction_moment;  ///< (w) the same in the second
  Eigen::VectorXd traction_work;    ///< (q) work of each unit traction on the displacements of the first, length
  double rounding = 0;              ///< bound of the change of S by rounding, estimated by the first, force / length
};

/// The file from stage 1 to stage 2 (schemas/plate-solution.md).
///
/// The nc = e + m controlled displacements are e rigid externals, then m discs. Unknowns are ordered by degree: the
/// rows of loads for degree p are the first ndof(p).
struct PlateSolution : UnitCases {
  pfem::Mesh mesh;
  std::vector<Eigen::Matrix3d> elasticity;  ///< elasticity of each material, stress
  /// (2, n_functions) class of u_x and u_y of each global function of the highest degree (pfem/numbering.hpp): >= 0 a
  /// plate unknown, -1 zero, -2 - i the controlled displacement i
  Eigen::Matrix2Xi unknown;
  std::vector<std::string> hole_id;
  std::vector<rim::Rim> hole_rim;
  std::vector<rim::HoleSpring> hole_spring;
  std::vector<rim::Section> sections;
  std::vector<pfem::CrackTip> tips;    ///< (t)
  std::vector<std::string> supported;  ///< directions fixed by a support
  Eigen::VectorXd held_stiffness;   ///< (nc) diagonal of K_cc: stiffness with all plate unknowns fixed, force / length
  Eigen::SparseMatrix<double> T_f;  ///< (n_f, q) loads of the unit tractions on the plate unknowns
  std::vector<rim::PointSpring> points;
  std::vector<PlateCases> cases;  ///< (n_p)
  Probe probe;

  /// True for the index of a degree that has all waves and the section forces.
  [[nodiscard]] bool has_stresses(Eigen::Index level) const { return level + n_stress_degrees >= p.size(); }
};

/// Throws FileError; an existing file at `path` is then kept.
void write(const std::string& path, const PlateSolution& solution);
[[nodiscard]] PlateSolution read_plate_solution(const std::string& path);

/// Rejects a PLATE.h5 with inconsistent datasets: elements, rims, plate unknowns, discs and unit cases are used as
/// indices later, so each must occur once and in the order of stage 1.
///
/// @param file Path of the file. Throws FileError with the dataset, what was found and what was expected.
void check_consistent(const std::string& file, const PlateSolution& plate);

}  // namespace fastjoint::formats
