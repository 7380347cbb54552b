// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/pfem/mesh.hpp"

namespace fastjoint::pfem {

/// What of a plate is extreme and can have made its stiffness badly conditioned, and what is allowed.
/// @param elasticity Of each material, stress. @param springs Stiffness of discs, rims or points, force / length.
[[nodiscard]] std::string extremes(const Mesh& mesh, const std::vector<Eigen::Matrix3d>& elasticity,
                                   const std::vector<double>& springs);

}  // namespace fastjoint::pfem
