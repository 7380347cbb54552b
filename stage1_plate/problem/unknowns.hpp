// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/plate/unknowns.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

using plate::Unknowns;

/// Indices of the externals of a kind into PlateScene::externals: those that are rigid, else those under a load.
[[nodiscard]] std::vector<int> rigid_externals(const PlateScene& scene);
[[nodiscard]] std::vector<int> traction_externals(const PlateScene& scene);

/// First disc of a point spring: the discs of these are the last.
[[nodiscard]] int disc_of_point(const PlateScene& scene, const Unknowns& unknowns, int point);

/// Applies supports and rigid externals. Throws InputError where two of them want the same displacement.
[[nodiscard]] Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate,
                                         const pfem::Numbering& numbering);

}  // namespace fastjoint::stage1
