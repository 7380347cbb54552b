// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {

/// GSL reports by return values from now on, instead of aborting; first GSL call of the program.
void take_over_gsl_errors();

/// GSL's hybridsj: Powell's hybrid method with scaled variables and derivatives, MINPACK's HYBRJ.
///
/// A step to where a value is not finite ends the search; what the functions throw comes out of here.
[[nodiscard]] Root hybridsj_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options);

}  // namespace fastjoint::stage3
