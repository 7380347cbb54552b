// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/rim/rim.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// The springs of a hole as stage 2 reads them: modulus 0 of an open hole, and of links.
[[nodiscard]] rim::HoleSpring spring_of(const Hole& hole);

/// Springs on one side of a rim, summed over points: quadrature points, or the two nodes of links.
struct SideSprings {
  pfem::SideRule rule;     ///< points with the traces of the shape functions there
  Eigen::VectorXd weight;  ///< (n_points) stiffness of each point, force / length; 0 where no spring acts
};
/// @param p Degree of the plate's space. Arcs are integrated exactly: pieces end where they do.
[[nodiscard]] SideSprings side_springs(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p);

/// Stiffness of the springs on one side of a sprung hole's rim, and loads of the unit friction cases there, over the
/// coefficients of the side's modes: first all of u_x, then all of u_y, local signs. a disc directions, n modes.
struct RimTerms {
  std::vector<int> modes;    ///< (n) local modes of the element
  Eigen::MatrixXd plate;     ///< (2n, 2n) int k t (v.n)(u.n) ds, force / length
  Eigen::MatrixXd coupling;  ///< (2n, a) -int k t (v.n)(e.n) ds, force / length
  Eigen::MatrixXd disc;      ///< (a, a) int k t (e.n)(e'.n) ds, force / length
  Eigen::MatrixXd friction;  ///< (2n, 2a) loads of unit friction, direction outer, bearing side + then -, length^2
  double stiffness;          ///< sum of the springs, force / length; 0 if none acts on the side
};

/// @param hole Index of a sprung hole of the scene. @param p Degree of the plate's space.
[[nodiscard]] RimTerms rim_terms(const PlateScene& scene, const PlateMesh& plate, std::size_t hole,
                                 const pfem::Side& side, int p);

}  // namespace fastjoint::stage1
