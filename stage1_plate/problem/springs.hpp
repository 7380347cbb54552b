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

}  // namespace fastjoint::stage1
