// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/rim/harmonics.hpp"

namespace fastjoint::stage1 {

/// Estimated relative error of the strains along the rims, and so of hoop stresses, in unit cases: of each rim twice
/// the change from the degree below, and what the last two pairs of orders leave for all to come, as in the error of a
/// peak (docs/theory.md, section 11.4); Frobenius norms over displacements and over tractions, the worst of all rims.
/// Infinite without a degree below, 0 without waves.
/// @param waves    Of every hole; those in contact stand first in the rows.
/// @param W, below Rows of formats::PlateCases::W at this degree and at the one below, which is empty if there is none.
/// @param n_displacements, n_tractions Columns of unit displacements, the first, and of unit tractions, the last.
[[nodiscard]] double hoop_error(const std::vector<std::optional<rim::Waves>>& waves, const Eigen::MatrixXd& W,
                                const Eigen::MatrixXd& below, Eigen::Index n_displacements, Eigen::Index n_tractions);

}  // namespace fastjoint::stage1
