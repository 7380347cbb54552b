// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/interfaces/fastener_interface.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// What a unit of friction's amounts Lambda does to a plate: a case of its R, or a force on a disc, which takes part of
/// a bearing force on itself.
struct FrictionColumn {
  Index plate;
  Index case_at;  ///< column of PlateModel::R; -1: a force on the disc
  Index disc;     ///< of such a force
};

/// The friction columns of a joint and who makes their amounts: fastener after fastener, then rim after rim.
struct FrictionLayout {
  std::vector<FrictionColumn> columns;
  std::vector<std::vector<RubbingHole>> rubbing;  ///< of each fastener
  std::vector<Index> n_columns;                   ///< of each fastener
  std::vector<bool> rim_rubs;                     ///< of each of rim_places
};
[[nodiscard]] FrictionLayout friction_layout(const JointModel& joint);

/// Loads on all unknowns of a joint by amounts of friction: what must act from outside for it, (N, columns).
/// @param Lambda (columns of the layout, columns).
[[nodiscard]] MatrixXd friction_loads(const JointModel& joint, const std::vector<FrictionColumn>& columns,
                                      const MatrixXd& Lambda);

}  // namespace fastjoint::stage3
