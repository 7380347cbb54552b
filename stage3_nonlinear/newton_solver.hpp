// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/root.hpp"

namespace fastjoint::stage3 {

/// Newton's method with damped steps: the guarantee behind the other solvers.
///
/// With problem.descent, a step goes on until the convex function whose gradient it gives no longer falls much: then
/// the method converges from everywhere if there is a solution. For the contact coordinate c = F + K delta of joints
/// without friction whose laws never fall that function is
///   phi(c) = 1/2 delta' S delta - q' delta + sum int F ddelta + 1/2 r' W^-1 r,   r = F + S delta - q,   W = K - S > 0,
/// the forward-backward envelope of the joint's energy (Patrinos, Stella & Bemporad 2014) in the metric K; its
/// gradient by c is W^-1 r, and J W with the tangent J is symmetric positive definite, so that Newton's step falls.
/// Without it, steps are halved until the norm of the residual falls, which promises nothing.
///
/// @param start (n), n >= 1
[[nodiscard]] Root newton_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
