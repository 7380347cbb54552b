// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// Newton's method with damped steps: the guarantee behind the other solvers.
///
/// With problem.descent, the gradient of a convex function, a step ends where that function has almost stopped falling
/// along it, and the method converges from every start if the function is bounded below. Joints without friction whose
/// laws never fall have such a function of the contact coordinate. docs/theory.md, section 8.4, derives it, proves
/// convergence and says where rounding limits it.
///
/// Without problem.descent, steps are halved until the norm of the residual falls; convergence is then not certain.
///
/// @param start (n), n >= 1
[[nodiscard]] Root newton_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
