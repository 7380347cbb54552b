// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

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
  /// Whether one of its edges is an arc.
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

}  // namespace fastjoint::pfem
