// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/count.hpp"
#include "common/pfem/numbering.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// The degrees of freedom of a plate (pfem/numbering.hpp says how one is written), and who moves those that are
/// controlled.
///
/// The nc = e + m controlled displacements are the rigid externals, then the discs in the order of list_discs. The
/// free unknowns keep the order of the functions, so those of degree <= k come first.
struct Unknowns {
  Eigen::Matrix2Xi dofs;    ///< (2, n_functions) what becomes of u_x and u_y of each global function
  std::vector<int> n_free;  ///< (p + 1) free unknowns of degree <= k
  int n_controlled = 0;
  int n_directions = 0;                                ///< number of directions of each disc
  std::vector<int> rigid, traction;                    ///< indices into PlateScene::externals
  std::vector<std::string> disc_hole, disc_direction;  ///< (m)
  std::vector<int> disc_of_hole;                       ///< (holes) first disc of the hole, or -1 for an open hole
  std::vector<int> disc_of_point;                      ///< (points) first disc of the point spring

  [[nodiscard]] int controlled_of_disc(int disc) const { return n_externals() + disc; }
  [[nodiscard]] int n_externals() const { return count_of(rigid); }
  [[nodiscard]] int n_discs() const { return count_of(disc_hole); }
};

/// Applies supports and rigid externals. Throws InputError where two of them want the same displacement.
[[nodiscard]] Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate,
                                         const pfem::Numbering& numbering);

}  // namespace fastjoint::stage1
