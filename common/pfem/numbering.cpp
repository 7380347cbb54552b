// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/numbering.hpp"

#include "common/pfem/trunk_space.hpp"

namespace fastjoint::pfem {
namespace {

/// Functions of degree k and the first of those inside the elements.
struct DegreeBlock {
  int first_edge, first_interior;
};

std::vector<DegreeBlock> degree_blocks(const Mesh& mesh, const Edges& edges, Numbering& numbering) {
  std::vector<DegreeBlock> blocks(static_cast<std::size_t>(numbering.p) + 1);
  numbering.n_functions = {0, mesh.n_nodes()};
  for (int k = 2; k <= numbering.p; ++k) {
    const int first = numbering.n_functions.back();
    const int interior_each = k >= 4 ? k - 3 : 0;
    blocks[static_cast<std::size_t>(k)] = {first, first + edges.size()};
    numbering.n_functions.push_back(first + edges.size() + interior_each * mesh.n_elements());
  }
  return blocks;
}

}  // namespace

Numbering number_by_degree(const Mesh& mesh, const Edges& edges, int p) {
  const auto modes = trunk_space(p);
  const auto n_modes = static_cast<Eigen::Index>(modes.size());
  Numbering numbering{p, {}, {}, Eigen::MatrixXd::Ones(n_modes, mesh.n_elements())};
  numbering.function.resize(n_modes, mesh.n_elements());
  const auto blocks = degree_blocks(mesh, edges, numbering);
  for (int element = 0; element < mesh.n_elements(); ++element) {
    numbering.function.col(element).head<4>() = mesh.quads.col(element);
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const int global = edges.of_element(edge, element);
      const bool against = mesh.quads(natural_ends(edge).first, element) != edges.nodes(0, global);
      for (int k = 2; k <= p; ++k) {
        numbering.function(edge_mode(p, edge, k), element) = blocks[static_cast<std::size_t>(k)].first_edge + global;
        if (against && k % 2 == 1) numbering.sign(edge_mode(p, edge, k), element) = -1;
      }
    }
    for (Eigen::Index m = edge_mode(p, n_local_edges, 2); m < n_modes; ++m) {
      const auto [i, j, k] = modes[static_cast<std::size_t>(m)];
      numbering.function(m, element) = blocks[static_cast<std::size_t>(k)].first_interior + element * (k - 3) + (i - 2);
    }
  }
  return numbering;
}

}  // namespace fastjoint::pfem
