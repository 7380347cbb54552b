// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/root.hpp"

namespace fastjoint::stage3 {

/// Newton's method with damped steps: the guarantee behind the other solvers.
///
/// With problem.descent, a step goes on until the convex function whose gradient it gives no longer falls much: then
/// the method converges from everywhere if that function is bounded below. For the contact coordinate c = F + K delta
/// of joints without friction whose laws never fall it is
///   phi(c) = 1/2 delta' S delta - q' delta + sum int F ddelta + 1/2 r' W^-1 r,   r = F + S delta - q,   W = K - S > 0,
/// the forward-backward envelope of the joint's energy (Patrinos, Stella & Bemporad 2014) in the metric K. Its gradient
/// by c is g = W^-1 r and its Hessian W^-1 J = W^-1 - ddelta/dc with the tangent J. That is >= W^-1 - K^-1 >= 0, and
/// with the trace of stiffness that the Jacobian has (root_problem) ddelta/dc < K^-1 keeps it away from 0, so that
/// Newton's steps -(W^-1 J)^-1 g point downhill, never nearly across.
///
/// Why it converges: phi never rises but in whole steps that halve the least |r| so far, of which there are as many as
/// halvings fit between the start and the tolerance. Of the other steps either infinitely many end where the slope is
/// little, then g -> 0 (Zoutendijk); or from some step on each halves |r|. All by the rounding of r: about
/// 1e-16 K delta, which exceeds 1e-10 of the load where gaps are a million times what the load stretches.
///
/// Without it, steps are halved until the norm of the residual falls, which promises nothing.
///
/// @param start (n), n >= 1
[[nodiscard]] Root newton_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
