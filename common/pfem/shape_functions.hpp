// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

namespace fastjoint::pfem {

/// Points and weights of a quadrature on [-1, 1], each of shape (n).
struct Rule {
  Eigen::VectorXd x, w;
};

/// Gauss-Legendre rule of n points, exact for polynomials of degree 2 n - 1; n >= 1.
[[nodiscard]] Rule gauss(int n);

/// Legendre polynomials P_0 ... P_p at points x, shape (p + 1, n_points).
[[nodiscard]] Eigen::MatrixXd legendre(int p, const Eigen::VectorXd& x);

/// Values and derivatives of functions at points, each of shape (n_functions, n_points).
struct Values {
  Eigen::MatrixXd N, dN;
};

/// Hierarchic shape functions on [-1, 1]: the two linear ones, then integrated Legendre polynomials.
///
/// N_0 = (1-x)/2, N_1 = (1+x)/2, N_k = phi_k = (P_k - P_{k-2}) / sqrt(2 (2k-1)) for k >= 2, so that
/// int phi_i' phi_j' dx = delta_ij. Szabo & Babuska, Finite Element Analysis, Wiley 1991, section 6.1.
///
/// @param p Polynomial degree, p >= 1.
/// @param x Points in [-1, 1], shape (n_points).
/// @return  Shape (p + 1, n_points).
[[nodiscard]] Values integrated_legendre(int p, const Eigen::VectorXd& x);

/// Highest polynomial degree of an element.
inline constexpr int highest_p = 8;

/// Interior functions phi_i(xi) phi_j(eta), i, j >= 2, of an element of degree p. Szabo & Babuska 1991, section 6.2.
enum class Space {
  trunk,    ///< i + j <= p: contains the polynomials of total degree p; used in the paper
  product,  ///< i, j <= p: contains the polynomials of degree p in each coordinate
};

/// Names of the spaces in inputs and files, in the order of the enumeration.
inline const std::vector<std::string> space_names = {"trunk", "product"};

[[nodiscard]] inline const std::string& name_of(Space space) { return space_names[static_cast<std::size_t>(space)]; }

/// @param name One of space_names.
[[nodiscard]] inline Space space_named(const std::string& name) {
  return static_cast<Space>(std::find(space_names.begin(), space_names.end(), name) - space_names.begin());
}

/// One shape function of a quadrilateral: N_i(xi) N_j(eta), with the N of integrated_legendre.
struct Mode {
  int i, j;
  int degree;  ///< lowest p with it: 1 for vertices, k for edge mode k, for interior ones i + j (trunk), max(i, j)
               ///< (product)
};

/// Local edges are numbered counter-clockwise from the bottom (eta = -1); vertex v starts edge v.
inline constexpr int n_local_edges = 4;

/// Modes of the space of degree p in the local order used everywhere: the four vertices counter-clockwise; edge modes k
/// = 2..p edge by edge; interior modes by degree.
/// Szabo & Babuska 1991, section 6.2: 4 p + (p-2)(p-3)/2 modes for p >= 4 (trunk), 4 p + (p-1)^2 (product).
[[nodiscard]] std::vector<Mode> modes(Space space, int p);

/// Local index of mode k = 2..p of an edge in modes(space, p) of either space.
[[nodiscard]] constexpr int edge_mode(int p, int edge, int k) { return 4 + edge * (p - 1) + (k - 2); }

/// Local modes that do not vanish on an edge: its two vertices in its natural direction, then its edge modes k = 2..p.
[[nodiscard]] std::vector<int> modes_on_edge(int p, int edge);

/// The two vertices of a local edge in its natural direction, that of growing xi or eta.
struct EdgeEnds {
  int first, second;
};
[[nodiscard]] constexpr EdgeEnds natural_ends(int edge) {
  constexpr EdgeEnds ends[n_local_edges] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  return ends[edge];
}

/// Coordinates (xi, eta) of points along a local edge, shape (2, n_points).
/// @param s Coordinates along the edge's natural direction, shape (n_points).
[[nodiscard]] Eigen::Matrix2Xd along_edge(int local_edge, const Eigen::VectorXd& s);

/// Shape functions and their derivatives at points of [-1, 1]^2.
struct ShapeValues {
  Eigen::MatrixXd N, dN_dxi, dN_deta;  ///< each (n_modes, n_points)
};

/// @param xi, eta Coordinates of the points, each of shape (n_points).
[[nodiscard]] ShapeValues shape_values(Space space, int p, const Eigen::VectorXd& xi, const Eigen::VectorXd& eta);

}  // namespace fastjoint::pfem
