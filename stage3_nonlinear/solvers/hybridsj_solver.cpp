// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/solvers/gsl_root.hpp"

namespace fastjoint::stage3 {

void take_over_gsl_errors() { gsl_set_error_handler_off(); }

Root hybridsj_root(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options) {
  return gsl::solve<gsl::WithDerivatives<gsl_multiroot_fdfsolver_hybridsj>>(problem, start, options);
}

}  // namespace fastjoint::stage3
