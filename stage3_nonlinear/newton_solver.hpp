// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/root.hpp"

namespace fastjoint::stage3 {

/// Newton's method, its step halved until the norm of the residual falls.
///
/// Stands behind the hybrid method: on random joints each of the two solves what the other leaves (theory.md
/// section 7).
///
/// @param start (n), n >= 1
[[nodiscard]] Root newton_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
