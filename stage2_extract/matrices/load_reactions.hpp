// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// R = E_c E_h^T, shape (nc, h), length^2: force that holds each external and disc while a unit friction case acts. By
/// reciprocity no friction case is solved for it (docs/theory.md, sections 4.2 and 4.4).
[[nodiscard]] Eigen::MatrixXd friction_reactions(const formats::PlateSolution& plate, std::size_t level);

/// T = K_cf V - T_c, shape (nc, q): force that holds each external and disc while a unit total force acts on each
/// traction boundary (docs/theory.md, section 4.3).
[[nodiscard]] Eigen::MatrixXd traction_reactions(const formats::PlateSolution& plate, std::size_t level);

/// C = T_f^T V, shape (q, q), length / force: mean displacement of boundary i per unit force on j, all else held.
[[nodiscard]] Eigen::MatrixXd traction_compliance(const formats::PlateSolution& plate, std::size_t level);

}  // namespace fastjoint::stage2
