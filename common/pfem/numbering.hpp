// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/pfem/space.hpp"

namespace fastjoint::pfem {

/// Global shape functions, ordered by polynomial degree: those of degree <= k come first, so that every
/// matrix of degree k is a leading block of that of degree p.
struct Numbering {
  Space space;
  int p;
  std::vector<int> n_functions;  ///< (p + 1) how many of degree <= k
  Eigen::MatrixXi function;      ///< (n_modes, n_elements) global function of a local mode
  Eigen::MatrixXd sign;  ///< (n_modes, n_elements) +1, or -1: an odd edge mode seen against the edge's direction
};

/// Vertices first; then for each degree k the edges' modes k (an edge runs from its lower to its higher node) and the
/// elements' interior modes of that degree.
[[nodiscard]] Numbering number_by_degree(const Mesh& mesh, const Edges& edges, Space space, int p);

}  // namespace fastjoint::pfem
