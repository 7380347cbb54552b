// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/space.hpp"

namespace fastjoint::pfem {

/// One shape function of a quadrilateral: N_i(xi) N_j(eta), with the N of integrated_legendre.
struct Mode {
  int i, j;
  int degree;  ///< of the space that it enters: 1 for vertices, k for edge mode k, inside i + j (trunk), max(i, j)
               ///< (product)
};

/// Local edges are numbered counter-clockwise from the bottom (eta = -1); vertex v starts edge v.
inline constexpr int n_local_edges = 4;

/// Modes of the space of degree p in the local order that everybody uses: the four vertices counter-clockwise; edge
/// modes k = 2..p edge by edge; interior modes by degree.
/// Szabo & Babuska 1991, section 6.2: 4 p + (p-2)(p-3)/2 modes for p >= 4 (trunk), 4 p + (p-1)^2 (product).
[[nodiscard]] std::vector<Mode> modes(Space space, int p);

/// Local index of mode k = 2..p of an edge in modes(space, p) of either space.
[[nodiscard]] constexpr int edge_mode(int p, int edge, int k) { return 4 + edge * (p - 1) + (k - 2); }

/// Local modes that do not vanish on an edge: its two vertices in its natural direction, then its own of k = 2..p.
[[nodiscard]] std::vector<int> modes_on_edge(int p, int edge);

/// The two vertices of a local edge in its natural direction, that of growing xi or eta.
struct EdgeEnds {
  int first, second;
};
[[nodiscard]] constexpr EdgeEnds natural_ends(int edge) {
  constexpr EdgeEnds ends[n_local_edges] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  return ends[edge];
}

/// Shape functions and their derivatives at points of [-1, 1]^2.
struct ShapeValues {
  Eigen::MatrixXd N, dN_dxi, dN_deta;  ///< each (n_modes, n_points)
};

/// @param xi, eta Coordinates of the points, each of shape (n_points).
[[nodiscard]] ShapeValues shape_values(Space space, int p, const Eigen::VectorXd& xi, const Eigen::VectorXd& eta);

}  // namespace fastjoint::pfem
