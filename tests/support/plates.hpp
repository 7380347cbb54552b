// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/plate_solution.hpp"
#include "stage1_plate/run/solve.hpp"
#include "stage2_extract/extract.hpp"

namespace fastjoint::test {

/// A problem with what couples its plate unknowns to the border, assembled the plain way: externals and discs, then
/// loaded waves, friction cases and other waves.
struct Problem : stage1::PlateProblem {
  Eigen::SparseMatrix<double> K_fc;  ///< (n_f, nc)
  Eigen::MatrixXd K_cc;              ///< (nc, nc) with all of the plate held
  Eigen::SparseMatrix<double> L_f;   ///< (n_f, n_border - nc) loads of the unit waves and friction cases
  Eigen::MatrixXd L_c;               ///< (nc, n_border - nc) what of them acts on the controlled displacements directly
};
[[nodiscard]] Problem assemble(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh);

/// Those of some modes among the degrees of freedom of an element.
[[nodiscard]] inline pfem::ElementDofs dofs_of(const pfem::ElementDofs& all, std::vector<int> modes) {
  const auto n_modes = static_cast<int>(all.dof.size() / 2);
  for (std::size_t i = 0, n = modes.size(); i < n; ++i) modes.push_back(n_modes + modes[i]);
  return {all.dof(modes), all.sign(modes)};
}

/// A scene with its mesh and matrices, as stage 1 has them before solving.
struct Plate {
  stage1::PlateScene scene;
  stage1::PlateMesh mesh;
  Problem problem;
};
[[nodiscard]] Plate make_plate(const std::string& json);

/// One column of loads on the free unknowns, shape (n_f).
[[nodiscard]] Eigen::VectorXd on_free(const stage1::PlateProblem& problem, const stage1::Loads& loads);

/// Plate unknowns at one degree under amounts of the border, (n_prescribed, k), and loads on them, (n_p, k); shape
/// (n_p, k).
[[nodiscard]] Eigen::MatrixXd fields(const stage1::PlateProblem& problem, int p, const Eigen::MatrixXd& border,
                                     const Eigen::MatrixXd& loads);
/// Plate unknowns per unit of each controlled displacement at one degree, shape (n_p, nc).
[[nodiscard]] Eigen::MatrixXd unit_fields(const stage1::PlateProblem& problem, int p);
/// Plate unknowns under loads on them, (n_p, k), with discs and externals held.
[[nodiscard]] Eigen::MatrixXd fields_under(const stage1::PlateProblem& problem, int p, const Eigen::MatrixXd& loads);

/// Stage 1 to the end, and stage 2 behind it.
[[nodiscard]] formats::PlateSolution solve(const Plate& plate);
[[nodiscard]] stage2::Extraction extract(const formats::PlateSolution& solution, bool stresses);
[[nodiscard]] stage2::Extraction extract(const std::string& json, bool stresses = true);

/// A hole in a grid.
struct HoleText {
  std::string id;
  double x, y, radius;
  int rings = 0;
  bool sprung = true;
};

/// Member of a scene whose discs move along x alone, with a comma behind it; empty if `members` say how they move.
[[nodiscard]] const char* one_direction(const std::string& members);

/// The common parts of a scene in consistent numbers: plane stress, E = 1e7, nu = 0.3, thickness 0.1.
/// @param extra More members, each with a comma before it.
[[nodiscard]] std::string grid_scene(const std::vector<double>& x, const std::vector<double>& y,
                                     const std::vector<HoleText>& holes, const std::string& extra = "");

/// panel(nx, ny): unit squares, each with a hole of diameter 0.25; ux = 0 left, uy = 0 bottom, right edge external.
/// @param extra As grid_scene has it.
[[nodiscard]] std::string panel(int nx, int ny, int rings = 0, const std::string& extra = "");

/// The member of a scene that chooses its space, with a comma before it.
[[nodiscard]] std::string in_space(pfem::Space space);

}  // namespace fastjoint::test
