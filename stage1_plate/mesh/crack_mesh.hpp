// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// A crack along edges of a mesh that is not yet open.
struct CrackPath {
  int crack;                               ///< index into PlateScene::cracks
  std::string pointer;                     ///< its place in the file, for messages
  std::vector<std::pair<int, int>> edges;  ///< nodes of each edge, in any order
};

/// Opens cracks: doubles the nodes along each path but its tips, and cuts the elements around a tip into layers whose
/// sizes fall by 0.2 from one to the next. Sides of sets and sections follow. Adds the tips to the plate.
/// Throws InputError if a path is not one connected line without branches, if one of its edges lies on the border, or
/// if the sheet around a tip has several thicknesses or materials, or an anisotropic one.
void open_cracks(const PlateScene& scene, const std::vector<CrackPath>& paths, PlateMesh& plate);

}  // namespace fastjoint::stage1
