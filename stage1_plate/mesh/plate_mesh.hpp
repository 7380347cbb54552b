// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/rim/rim.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// The sheet as elements, with the names that supports and externals use and the rims of the holes.
struct PlateMesh {
  pfem::Mesh mesh;
  pfem::Edges edges;
  std::map<std::string, std::vector<pfem::Side>> sets;  ///< sides of elements by name
  std::vector<rim::Rim> rims;                           ///< of each hole, in the scene's order
  std::vector<int> point_nodes;                         ///< vertex of each point spring
  std::vector<rim::Section> sections;                   ///< beside holes, in the order of the holes
};

/// Meshes the scene and finds the holes' rims. Throws InputError if a hole does not fit or an element is folded.
[[nodiscard]] PlateMesh make_mesh(const PlateScene& scene);

}  // namespace fastjoint::stage1
