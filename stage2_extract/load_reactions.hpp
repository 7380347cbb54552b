// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// R = E_c E_h^T = -(U^T L_f + L_c), shape (nc, h), length^2: force that holds each external and disc while a unit
/// friction case acts, by reciprocity (Betti) with the unit displacement fields: no friction case is solved for it.
[[nodiscard]] Eigen::MatrixXd friction_reactions(const formats::PlateSolution& plate, std::size_t level);

/// T = K_cf V - T_c, shape (nc, q): the same for a unit total force on each traction boundary.
[[nodiscard]] Eigen::MatrixXd traction_reactions(const formats::PlateSolution& plate, std::size_t level);

/// C = T_f^T V, shape (q, q), length / force: mean displacement of boundary i per unit force on j, all else held.
[[nodiscard]] Eigen::MatrixXd traction_compliance(const formats::PlateSolution& plate, std::size_t level);

}  // namespace fastjoint::stage2
