// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::bench {

struct Solver {
  const char* name;  ///< GSL's, or "damped newton"
  stage3::SolveFunction solve;
};

/// The two solvers of the program and beside them the seven other methods of GSL that it could have: with derivatives
/// hybridj, newton and gnewton, without hybrids, hybrid, dnewton and broyden.
[[nodiscard]] const std::vector<Solver>& solvers();

}  // namespace fastjoint::bench
