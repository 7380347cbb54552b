// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/interfaces/fastener_interface.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Load on a plate per unit of an amplitude Lambda of friction: a case of its R, or a force on a disc that carries a
/// part of the bearing force.
struct FrictionColumn {
  Index plate;
  Index case_at;  ///< column of PlateModel::R; -1: a force on the disc
  Index disc;     ///< disc of such a force
};

/// The friction columns of a joint and their origin: fastener after fastener, then rim after rim.
struct FrictionLayout {
  std::vector<FrictionColumn> columns;
  std::vector<std::vector<FrictionHole>> friction_holes;  ///< of each fastener
  std::vector<Index> n_columns;                           ///< of each fastener
};
[[nodiscard]] FrictionLayout friction_layout(const JointModel& joint);

/// External forces on all unknowns of a joint in equilibrium with friction of amplitudes Lambda, (N, columns).
/// @param Lambda (columns of the layout, columns).
[[nodiscard]] MatrixXd friction_loads(const JointModel& joint, const std::vector<FrictionColumn>& columns,
                                      const MatrixXd& Lambda);

}  // namespace fastjoint::stage3
