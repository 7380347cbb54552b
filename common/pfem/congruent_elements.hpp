// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/mesh.hpp"
#include "common/pfem/space.hpp"

namespace fastjoint::pfem {

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
