// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {

/// Global shape functions, ordered by polynomial degree: those of degree <= k come first, so that every
/// matrix of degree k is a leading block of that of degree p.
struct Numbering {
  Space space;
  int p;
  std::vector<int> n_functions;  ///< (p + 1) number of functions of degree <= k
  Eigen::MatrixXi function;      ///< (n_modes, n_elements) global function of a local mode
  Eigen::MatrixXd sign;  ///< (n_modes, n_elements) -1 for odd modes of edges that the element runs against, else +1
};

/// Vertices first; then for each degree k the edges' modes k (an edge runs from its lower to its higher node) and the
/// elements' interior modes of that degree.
[[nodiscard]] Numbering number_by_degree(const Mesh& mesh, const Edges& edges, Space space, int p);

/// Class of a degree of freedom, u_x or u_y of a global function, as one number: i >= 0 is the free unknown i, -1 is
/// fixed at zero, -2 - i is the controlled displacement i.
inline constexpr int fixed_dof = -1;
[[nodiscard]] constexpr int controlled_dof(int index) { return -2 - index; }
[[nodiscard]] constexpr bool is_free(int dof) { return dof >= 0; }
[[nodiscard]] constexpr bool is_controlled(int dof) { return dof < fixed_dof; }
[[nodiscard]] constexpr int controlled_index(int dof) { return -2 - dof; }

/// The degrees of freedom of the n modes of an element, first u_x of all, then u_y of all.
struct ElementDofs {
  Eigen::VectorXi dof;   ///< (2n) class of each
  Eigen::VectorXd sign;  ///< (2n) value of the global function per local mode, +1 or -1
};
/// @param dofs Class of u_x and u_y of each global function, shape (2, n_functions).
[[nodiscard]] ElementDofs element_dofs(const Numbering& numbering, const Eigen::Matrix2Xi& dofs, int element);

}  // namespace fastjoint::pfem
