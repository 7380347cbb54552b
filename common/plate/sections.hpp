// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/plate/plate_factor.hpp"
#include "common/rim/rim.hpp"

namespace fastjoint::plate {

/// Normal force over every section, tension positive, then shear force over every section, positive where the shear
/// stress xy is: functions of the plate's displacements at the degree of a factor, the integrals of the stress,
/// averaged over the elements on both sides of the section.
/// @param elasticity Elasticity of each material, stress.
[[nodiscard]] PlateFactor::Functions section_forces(const PlateFactor& factor, const pfem::Mesh& mesh,
                                                    const pfem::Edges& edges, const pfem::Numbering& numbering,
                                                    const std::vector<Eigen::Matrix3d>& elasticity,
                                                    const std::vector<rim::Section>& sections);

}  // namespace fastjoint::plate
