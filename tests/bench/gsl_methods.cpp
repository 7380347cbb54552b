// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/gsl_methods.hpp"

#include "stage3_nonlinear/solvers/gsl_root.hpp"

namespace fastjoint::bench {
namespace {

using namespace stage3::gsl;

/// Solvers without the Jacobian.
template <const gsl_multiroot_fsolver_type*& type>
struct WithoutDerivatives {
  using Handle = gsl_multiroot_fsolver;
  gsl_multiroot_function functions;

  WithoutDerivatives(Payload& payload, std::size_t n) : functions{residual, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fsolver_iterate(solver); }
};

}  // namespace

const std::vector<Solver>& solvers() {
  static const std::vector<Solver> solvers{
      {"hybridsj", stage3::hybridsj_root},
      {"hybridj", solve<WithDerivatives<gsl_multiroot_fdfsolver_hybridj>>},
      {"newton", solve<WithDerivatives<gsl_multiroot_fdfsolver_newton>>},
      {"gnewton", solve<WithDerivatives<gsl_multiroot_fdfsolver_gnewton>>},
      {"hybrids", solve<WithoutDerivatives<gsl_multiroot_fsolver_hybrids>>},
      {"hybrid", solve<WithoutDerivatives<gsl_multiroot_fsolver_hybrid>>},
      {"dnewton", solve<WithoutDerivatives<gsl_multiroot_fsolver_dnewton>>},
      {"broyden", solve<WithoutDerivatives<gsl_multiroot_fsolver_broyden>>},
      {"damped newton", stage3::newton_root},
  };
  return solvers;
}

}  // namespace fastjoint::bench
