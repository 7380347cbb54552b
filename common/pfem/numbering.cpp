// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/numbering.hpp"

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {
namespace {

/// Functions of degree k: the first edge function, the first interior function, and the number of interior functions of
/// an element.
struct DegreeBlock {
  int first_edge = 0, first_interior = 0, n_interior = 0;
};

std::vector<DegreeBlock> degree_blocks(const Mesh& mesh, const Edges& edges, const std::vector<Mode>& modes,
                                       Numbering& numbering) {
  std::vector<DegreeBlock> blocks(numbering.p + 1);
  for (int m = edge_mode(numbering.p, n_local_edges, 2); m < count_of(modes); ++m) ++blocks[modes[m].degree].n_interior;
  numbering.n_functions = {0, mesh.n_nodes()};
  for (int k = 2; k < count_of(blocks); ++k) {
    blocks[k].first_edge = numbering.n_functions.back();
    blocks[k].first_interior = blocks[k].first_edge + edges.size();
    numbering.n_functions.push_back(blocks[k].first_interior + blocks[k].n_interior * mesh.n_elements());
  }
  return blocks;
}

}  // namespace

Numbering number_by_degree(const Mesh& mesh, const Edges& edges, Space space, int p) {
  const auto list = modes(space, p);
  const Eigen::Index n_modes = list.size();
  Numbering numbering{space, p, {}, {}, Eigen::MatrixXd::Ones(n_modes, mesh.n_elements())};
  numbering.function.resize(n_modes, mesh.n_elements());
  const auto blocks = degree_blocks(mesh, edges, list, numbering);
  for (int element = 0; element < mesh.n_elements(); ++element) {
    numbering.function.col(element).head<4>() = mesh.quads.col(element);
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const int global = edges.of_element(edge, element);
      const bool against = mesh.quads(natural_ends(edge).first, element) != edges.nodes(0, global);
      for (int k = 2; k <= p; ++k) {
        numbering.function(edge_mode(p, edge, k), element) = blocks[k].first_edge + global;
        if (against && k % 2 == 1) numbering.sign(edge_mode(p, edge, k), element) = -1;
      }
    }
    Eigen::Index m = edge_mode(p, n_local_edges, 2);
    for (const auto& block : blocks)
      for (int i = 0; i < block.n_interior; ++i)
        numbering.function(m++, element) = block.first_interior + element * block.n_interior + i;
  }
  return numbering;
}

ElementDofs element_dofs(const Numbering& numbering, const Eigen::Matrix2Xi& dofs, int element) {
  const Eigen::VectorXi function = numbering.function.col(element);
  ElementDofs result{Eigen::VectorXi(2 * function.size()), numbering.sign.col(element).replicate(2, 1)};
  result.dof << dofs(0, function).transpose(), dofs(1, function).transpose();
  return result;
}

}  // namespace fastjoint::pfem
