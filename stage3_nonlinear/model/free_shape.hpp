// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Displacements of the discs and externals of a sheet without forces, as it lies before the joint is made.
struct FreeShape {
  VectorXd D, De;     ///< (m), (e) length
  VectorXd traction;  ///< (q) mean along each traction, length; 0 of a moment
};

/// The shape of a sheet in the place and at the temperature of its matrices.
[[nodiscard]] FreeShape undisplaced(const PlateModel& plate);

/// Shapes of the free sheets of a joint in a load case: their expansion by temperature about the supports, and holes
/// that are off their place (docs/theory.md, section 4.6). Forces follow from what displacements differ from them.
///
/// Throws InputError for the temperature of a sheet whose expansion or places are not known, or which supports hold at
/// two places along one direction, between which it cannot expand.
[[nodiscard]] std::vector<FreeShape> free_shapes(const JointModel& joint, const JointScene& scene,
                                                 const CaseScene& its);

/// Relative displacements of all planes at which the free sheets lie, (n a), length; empty if all are 0.
[[nodiscard]] VectorXd free_offsets(const JointModel& joint, const std::vector<FreeShape>& shapes);

/// Growth of the radial gap of a fastener in a hole by the temperatures of sheet and shank, length; 0 without
/// FastenerScene::expansion.
/// @param fastener, at Indices of the fastener and of its hole.
[[nodiscard]] double gap_growth(const JointModel& joint, const JointScene& scene, const CaseScene& its, Index fastener,
                                Index at);

}  // namespace fastjoint::stage3
