// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/root.hpp"

namespace fastjoint::stage3 {

/// GSL reports by return values from now on, instead of aborting; first GSL call of the program.
void take_over_gsl_errors();

/// Powell's hybrid method with scaled variables (MINPACK's HYBRJ, gsl_multiroot_fdfsolver_hybridsj).
///
/// A step to where a value is not finite ends the search; what the functions throw comes out of here.
///
/// @param start (n), n >= 1
[[nodiscard]] Root hybrid_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
