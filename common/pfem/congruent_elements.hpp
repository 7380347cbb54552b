// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/pfem/space.hpp"

namespace fastjoint::pfem {

/// Which elements of a mesh are congruent: of the same shape up to translation (to 1e-12 of the element's size, far
/// above the rounding of coordinates and far below what a stiffness shows) and of the same material. A panel of riveted
/// cells has eight different elements, not thousands.
struct CongruentElements {
  std::vector<int> shape;  ///< (n_elements) index of the element's shape
  std::vector<int> first;  ///< (shapes) the first element that has it, ascending
};
[[nodiscard]] CongruentElements find_congruent(const Mesh& mesh, const Edges& edges);

/// Stiffness matrices of every shape, of unit thickness, each shape (2 n_modes, 2 n_modes) as ElementStiffness has it,
/// force / length^2; on all threads.
/// @param elasticity Of each material of the mesh, (3, 3), stress.
[[nodiscard]] std::vector<Eigen::MatrixXd> integrate(const CongruentElements& congruent, const Mesh& mesh,
                                                     const Edges& edges, const std::vector<Eigen::Matrix3d>& elasticity,
                                                     Space space, int p);

}  // namespace fastjoint::pfem
