// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/solver.hpp"

namespace fastjoint::stage3 {

/// GSL reports by return values from now on, instead of aborting; first GSL call of the program.
void take_over_gsl_errors();

/// Those of GSL, by GSL's names: with derivatives hybridsj (Powell's hybrid method with scaled variables, MINPACK's
/// HYBRJ), hybridj, newton, gnewton; without hybrids, hybrid, dnewton, broyden.
///
/// A step to where a value is not finite ends the search; what the functions throw comes out of there.
[[nodiscard]] const std::vector<Solver>& gsl_solvers();

}  // namespace fastjoint::stage3
