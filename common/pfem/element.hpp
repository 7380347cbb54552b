// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <mutex>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {

/// Exact map of [-1, 1]^2 onto an element by blending its four edge curves (transfinite interpolation).
/// Gordon & Hall 1973; Szabo & Babuska 1991, section 6.3.
class ElementMap {
 public:
  ElementMap(const Mesh& mesh, const Edges& edges, int element);

  [[nodiscard]] Eigen::Vector2d point(double xi, double eta) const;
  /// Columns dx/dxi and dx/deta.
  [[nodiscard]] Eigen::Matrix2d jacobian(double xi, double eta) const;
  /// True if one of its edges is an arc.
  [[nodiscard]] bool is_curved() const;

 private:
  // Curves and vertices are relative to vertex 0, so that the rounding of coordinates does not vary within small
  // elements.
  Eigen::Vector2d origin_;
  std::array<Curve, 4> curves_;  ///< bottom, right, top, left in their natural directions
  Eigen::Matrix<double, 2, 4> vertices_;
};

/// Strain-displacement matrix of an element, shape (3 n_points, 2 n_modes): rows (eps_x, eps_y, gamma_xy) point by
/// point; columns first the coefficients of u_x, then those of u_y, local signs.
/// @param xi, eta Coordinates of the points, each of shape (n_points).
[[nodiscard]] Eigen::MatrixXd strain_operator(const ElementMap& map, Space space, int p, const Eigen::VectorXd& xi,
                                              const Eigen::VectorXd& eta);

/// A rectangle of [-1, 1]^2, by default all of it.
struct Box {
  Eigen::Vector2d middle{0, 0}, half{1, 1};
};

/// Stiffness matrices of elements of one space and degree p. The geometric degree of an element sets its number of
/// quadrature points; shape functions are tabulated once for each number. An element above the highest geometric degree
/// is nearly folded: it is bisected recursively until each part is below it.
class ElementStiffness {
 public:
  /// @param extra Points added in each direction to those chosen from p and the element's shape (for tests).
  explicit ElementStiffness(Space space, int p, int extra = 0);

  /// int B^T D B t dA, equation (3a), shape (2 n_modes, 2 n_modes), force / length: first the n_modes
  /// coefficients of u_x, then those of u_y, local signs (no edge orientation).
  /// @param D Elasticity, (3, 3), stress. @param thickness Length. @param box Part of the element to integrate over.
  [[nodiscard]] Eigen::MatrixXd operator()(const ElementMap& map, const Eigen::Matrix3d& D, double thickness,
                                           const Box& box = {}) const;

 private:
  struct Table {
    Eigen::VectorXd xi, eta, w;
    ShapeValues shape;
  };
  [[nodiscard]] Table make_table(int n_points, const Box& box) const;
  /// Table for all of [-1, 1]^2, made at its first use; thread-safe.
  [[nodiscard]] const Table& table(int n_points) const;

  Space space_;
  int p_, extra_;
  mutable std::mutex mutex_;
  mutable std::map<int, Table> tables_;
};

/// Degree in each coordinate of the polynomial that approximates the geometric factor det J J^-1 J^-T of the stiffness
/// on a part of an element to 1e-11 of its largest coefficient; 0 for a parallelogram (docs/theory.md, section 2.5).
struct GeometricDegree {
  int degree;   ///< at most highest_geometric_degree, which also stands for all above
  int steeper;  ///< the coordinate, 0 or 1, with the larger coefficient of that degree
};
inline constexpr int highest_geometric_degree = 19;
[[nodiscard]] GeometricDegree geometric_degree(const ElementMap& map, const Box& box = {});

/// Minimum of the Jacobian determinant of an element over a grid of points with its vertices and edges, relative to the
/// mean.
/// The map is one to one only if it is positive.
[[nodiscard]] double jacobian_ratio(const ElementMap& map);

/// Congruence classes of the elements of a mesh: elements equal up to translation and of one material. The tolerance,
/// 1e-12 of the element's size, is far above the rounding of coordinates and has no visible effect on a stiffness. A
/// panel of riveted cells has eight classes instead of thousands.
struct CongruentElements {
  std::vector<int> class_of;  ///< (n_elements) index of the element's class
  std::vector<int> first;     ///< (classes) first element of each class, ascending
};
[[nodiscard]] CongruentElements find_congruent(const Mesh& mesh, const Edges& edges);

/// Integrates, on all threads, the stiffness matrices of all congruence classes at unit thickness, each of shape (2
/// n_modes, 2 n_modes) as in ElementStiffness, force / length^2.
/// @param elasticity Elasticity of each material of the mesh, (3, 3), stress.
[[nodiscard]] std::vector<Eigen::MatrixXd> integrate(const CongruentElements& congruent, const Mesh& mesh,
                                                     const Edges& edges, const std::vector<Eigen::Matrix3d>& elasticity,
                                                     Space space, int p);

}  // namespace fastjoint::pfem
