// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/rim/rim.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// The mesh of a plate, with the named sets of supports and externals and the rims of the holes.
struct PlateMesh {
  pfem::Mesh mesh;
  pfem::Edges edges;
  std::map<std::string, std::vector<pfem::Side>> sets;  ///< sides of elements by name
  std::vector<rim::Rim> rims;                           ///< rim of each hole, in the scene's order
  std::vector<int> point_nodes;                         ///< vertex of each point spring
  std::vector<rim::Section> sections;                   ///< sections next to holes, in the order of the holes
  std::vector<pfem::CrackTip> tips;                     ///< tips of cracks, in the scene's order
  std::vector<std::string> moved_lines;                 ///< cell lines that were moved for tips, and where to
  std::vector<bool> is_cracked;                         ///< for each hole: true if a crack begins at its rim
};

/// The edge between two nodes. Throws InputError for the place in the file if no element has it.
[[nodiscard]] int edge_between(const PlateScene& scene, const pfem::Edges& edges, const std::string& pointer, int a,
                               int b);

/// Meshes the scene and finds the holes' rims. Throws InputError if a hole does not fit or an element is folded.
[[nodiscard]] PlateMesh make_mesh(const PlateScene& scene);

/// Meshes a grid of cells with holes, without rims. A cell with a hole becomes a fan of ring elements from the hole's
/// arcs to the cell's outline (and extra rings, graded towards the hole), any other cell rectangles.
/// The mesh is conforming; the sets "left", "right", "bottom", "top" are the sides on the boundary.
[[nodiscard]] PlateMesh mesh_grid(const PlateScene& scene, const GridGeometry& grid);

/// Uses the user's mesh unchanged, without rims. Throws InputError if it is not conforming (an edge of more than two
/// elements, a hanging node, an arc without an edge, an unused node), if a named edge does not exist, if an edge of a
/// set is inside the plate, or if the edges of a section are not straight, not on one line across the section's
/// direction, or not beyond the rim on that side of the hole.
[[nodiscard]] PlateMesh mesh_explicit(const PlateScene& scene, const MeshGeometry& geometry);

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

/// The outline of the sheet without holes and cracks, arcs as chords.
[[nodiscard]] std::vector<pfem::OutlinePiece> outline_of(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
