// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"

namespace fastjoint::pfem {

/// Quadrature along one side of an element, with the traces of the shape functions that do not vanish there.
struct SideRule {
  std::vector<int> modes;   ///< (n) local modes: the two vertices and the edge's own
  Eigen::MatrixXd N;        ///< (n, n_points) their values, local signs
  Eigen::Matrix2Xd x;       ///< (2, n_points) points, length
  Eigen::Matrix2Xd normal;  ///< (2, n_points) unit normals out of the element
  Eigen::VectorXd ds;       ///< (n_points) weights, length
};

/// @param breaks Coordinates in (-1, 1) along the side's natural direction where the integrand or its slope jumps:
///               each piece is integrated on its own. Ascending.
[[nodiscard]] SideRule side_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p,
                                 const std::vector<double>& breaks = {});

}  // namespace fastjoint::pfem
