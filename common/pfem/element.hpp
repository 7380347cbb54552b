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
  std::array<Curve, 4> curves_;  ///< bottom, right, top, left in their natural directions
  Eigen::Matrix<double, 2, 4> vertices_;
};

/// Strains of an element per coefficient, shape (3 n_points, 2 n_modes): rows (eps_x, eps_y, gamma_xy) point after
/// point, first the coefficients of u_x, then those of u_y, local signs.
/// @param xi, eta Coordinates of the points, each of shape (n_points).
[[nodiscard]] Eigen::MatrixXd strain_operator(const ElementMap& map, Space space, int p, const Eigen::VectorXd& xi,
                                              const Eigen::VectorXd& eta);

/// A rectangle of [-1, 1]^2, by default all of it.
struct Box {
  Eigen::Vector2d middle{0, 0}, half{1, 1};
};

/// Stiffness matrices of elements of one space and degree p. Shape functions are tabulated once for each number
/// of points; how many an element takes follows from its geometric degree. An element of more than the highest is
/// nearly folded: it is integrated by halves, and these by theirs, until each has less.
class ElementStiffness {
 public:
  /// @param extra Points added in each direction to those chosen from p and the element's shape (for tests).
  explicit ElementStiffness(Space space, int p, int extra = 0);

  /// int B^T D B t dA, equation (3a), shape (2 n_modes, 2 n_modes), force / length: first the n_modes
  /// coefficients of u_x, then those of u_y, local signs (no edge orientation).
  /// @param D Elasticity, (3, 3), stress. @param thickness Length. @param box The part of the element that counts.
  [[nodiscard]] Eigen::MatrixXd operator()(const ElementMap& map, const Eigen::Matrix3d& D, double thickness,
                                           const Box& box = {}) const;

 private:
  struct Table {
    Eigen::VectorXd xi, eta, w;
    ShapeValues shape;
  };
  [[nodiscard]] Table make_table(int n_points, const Box& box) const;
  /// The table of all of [-1, 1]^2, made when first asked for, from any thread.
  [[nodiscard]] const Table& table(int n_points) const;

  Space space_;
  int p_, extra_;
  mutable std::mutex mutex_;
  mutable std::map<int, Table> tables_;
};

/// Degree of the polynomials, in each coordinate, that represent the geometry's factor det J J^-1 J^-T of a stiffness
/// on a part of an element to 1e-11 of its largest coefficient; 0 of a parallelogram (docs/theory.md, section 2.5).
struct GeometricDegree {
  int degree;   ///< the highest also stands for all that are higher
  int steeper;  ///< the coordinate, 0 or 1, in which it has more of that degree
};
inline constexpr int highest_geometric_degree = 19;
[[nodiscard]] GeometricDegree geometric_degree(const ElementMap& map, const Box& box = {});

/// Smallest Jacobian determinant of an element at its integration points and vertices, over its mean.
/// The map is one to one only if it is positive.
[[nodiscard]] double jacobian_ratio(const ElementMap& map);

/// The congruence classes of the elements of a mesh: equal up to translation (to 1e-12 of the element's size, far above
/// the rounding of coordinates and far below what a stiffness shows), and of one material. A panel of riveted cells has
/// eight classes, not thousands.
struct CongruentElements {
  std::vector<int> class_of;  ///< (n_elements) index of the element's class
  std::vector<int> first;     ///< (classes) the first element of each, ascending
};
[[nodiscard]] CongruentElements find_congruent(const Mesh& mesh, const Edges& edges);

/// Stiffness matrices of all congruence classes at unit thickness, each of shape (2 n_modes, 2 n_modes) as
/// ElementStiffness has it, force / length^2; integrated on all threads.
/// @param elasticity Elasticity of each material of the mesh, (3, 3), stress.
[[nodiscard]] std::vector<Eigen::MatrixXd> integrate(const CongruentElements& congruent, const Mesh& mesh,
                                                     const Edges& edges, const std::vector<Eigen::Matrix3d>& elasticity,
                                                     Space space, int p);

}  // namespace fastjoint::pfem
