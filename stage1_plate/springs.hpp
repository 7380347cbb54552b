// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/assembler.hpp"

namespace fastjoint::stage1 {

/// The springs of a hole as stage 2 reads them: modulus 0 of an open hole, and of links.
[[nodiscard]] formats::HoleSpring spring_of(const Hole& hole);

/// Springs on one side of a rim, summed over points: quadrature points, or the two nodes of links.
struct SideSprings {
  pfem::SideRule rule;     ///< points with the traces of the shape functions there
  Eigen::VectorXd weight;  ///< (n_points) stiffness of each point, force / length; 0 where no spring acts
};
/// @param p Degree of the plate's space. Arcs are integrated exactly: pieces end where they do.
[[nodiscard]] SideSprings side_springs(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p);

/// Normal springs between every rim and its rigid disc, equation (6): adds int k t (v.n)(u.n) ds to the plate,
/// -int k t (u.n)(e.n) ds between plate and disc, int k t (e.n)(e'.n) ds to the disc; sums over nodes for links.
/// Throws InputError for an arc that the rim of the model does not have.
void add_springs(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                 const Unknowns& unknowns, Assembler& assembler);

}  // namespace fastjoint::stage1
