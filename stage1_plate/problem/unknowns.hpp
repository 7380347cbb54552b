// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/count.hpp"
#include "common/pfem/numbering.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// What becomes of each coefficient (global function x component): a free unknown, zero, or a controlled displacement.
///
/// The nc = e + m controlled displacements are the rigid externals, then the discs in the order of list_discs. The
/// free unknowns keep the order of the functions, so those of degree <= k come first.
struct Unknowns {
  std::vector<int> target;  ///< (2 n_functions), at 2 function + component: see below
  std::vector<int> n_free;  ///< (p + 1) free unknowns of degree <= k
  int n_controlled = 0;
  int n_directions = 0;                                ///< of the discs
  std::vector<int> rigid, traction;                    ///< indices into PlateScene::externals
  std::vector<std::string> disc_hole, disc_direction;  ///< (m)
  std::vector<int> disc_of_hole;                       ///< (holes) first disc of the hole, or -1 for an open hole
  std::vector<int> disc_of_point;                      ///< (points) first disc of the point spring

  static constexpr int fixed = -1;
  [[nodiscard]] static constexpr int controlled(int index) { return -2 - index; }
  [[nodiscard]] static constexpr bool is_free(int target) { return target >= 0; }
  [[nodiscard]] static constexpr bool is_controlled(int target) { return target < fixed; }
  [[nodiscard]] static constexpr int controlled_index(int target) { return -2 - target; }

  [[nodiscard]] int controlled_of_disc(int disc) const { return n_externals() + disc; }
  [[nodiscard]] int n_externals() const { return count_of(rigid); }
  [[nodiscard]] int n_discs() const { return count_of(disc_hole); }
};

/// Applies supports and rigid externals. Throws InputError where two of them want the same displacement.
[[nodiscard]] Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate,
                                         const pfem::Numbering& numbering);

}  // namespace fastjoint::stage1
