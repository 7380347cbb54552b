// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/rim/harmonics.hpp"

namespace fastjoint::stage1 {

/// Estimates the relative error of the strains along the rims, and so of hoop stresses, in unit cases: for each rim
/// twice the change from the degree below, plus the sum of all higher orders extrapolated from the last two pairs, as
/// in the error of a peak (docs/theory.md, section 11.4). Returns the maximum over all rims of Frobenius norms over
/// displacements and over tractions; infinite without a degree below, 0 without waves.
/// @param waves    Waves of every hole; those in contact come first in the rows.
/// @param W, below Rows of formats::PlateCases::W at this degree and at the one below, which is empty if there is none.
/// @param n_displacements, n_tractions Columns of unit displacements, the first, and of unit tractions, the last.
[[nodiscard]] double hoop_error(const std::vector<std::optional<rim::Waves>>& waves, const Eigen::MatrixXd& W,
                                const Eigen::MatrixXd& below, Eigen::Index n_displacements, Eigen::Index n_tractions);

}  // namespace fastjoint::stage1
