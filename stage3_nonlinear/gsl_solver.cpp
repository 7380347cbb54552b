// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/gsl_solver.hpp"

#include <gsl/gsl_multiroots.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "stage3_nonlinear/gsl_callback.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;

int evaluate_both(const gsl_vector* x, void* params, gsl_vector* f, gsl_matrix* J) noexcept {
  const int evaluated = evaluate<RootProblem>(x, params, f);
  return evaluated == GSL_SUCCESS ? differentiate<RootProblem>(x, params, J) : evaluated;
}

/// GSL's two families behind one set of names.
template <const gsl_multiroot_fdfsolver_type*& type>
struct WithDerivatives {
  using Handle = gsl_multiroot_fdfsolver;
  gsl_multiroot_function_fdf functions;

  WithDerivatives(Payload<RootProblem>& payload, std::size_t n)
      : functions{evaluate<RootProblem>, differentiate<RootProblem>, evaluate_both, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fdfsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fdfsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fdfsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fdfsolver_iterate(solver); }
};

template <const gsl_multiroot_fsolver_type*& type>
struct WithoutDerivatives {
  using Handle = gsl_multiroot_fsolver;
  gsl_multiroot_function functions;

  WithoutDerivatives(Payload<RootProblem>& payload, std::size_t n) : functions{evaluate<RootProblem>, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fsolver_iterate(solver); }
};

template <class Family>
void iterate(typename Family::Handle* solver, const RootOptions& options, Root& root) {
  for (int status = GSL_SUCCESS; status == GSL_SUCCESS; status = Family::iterate(solver)) {
    root.x = view(solver->x);
    root.residual = view(solver->f);
    if (!root.residual.allFinite()) {  // at the start, where GSL does not ask
      root.residual.setConstant(std::numeric_limits<double>::infinity());
      return;
    }
    root.converged = root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance;
    if (root.converged || root.iterations == options.max_iterations) return;
    ++root.iterations;
  }
}

template <class Family>
Root solve(const RootProblem& problem, const VectorXd& start, const RootOptions& options) {
  Payload<RootProblem> payload{problem, nullptr};
  const auto n = static_cast<std::size_t>(start.size());
  Family family(payload, n);
  const std::unique_ptr<typename Family::Handle, decltype(&Family::free)> solver(Family::alloc(n), &Family::free);
  if (!solver) throw std::bad_alloc();
  const gsl_vector_const_view x0 = gsl_vector_const_view_array(start.data(), n);
  Root root{start, VectorXd::Constant(start.size(), std::numeric_limits<double>::infinity())};
  if (family.set(solver.get(), &x0.vector) == GSL_SUCCESS) iterate<Family>(solver.get(), options, root);
  if (payload.thrown) std::rethrow_exception(payload.thrown);
  return root;
}

}  // namespace

void take_over_gsl_errors() { gsl_set_error_handler_off(); }

const std::vector<Solver>& gsl_solvers() {
  static const std::vector<Solver> solvers{
      {"hybridsj", solve<WithDerivatives<gsl_multiroot_fdfsolver_hybridsj>>},
      {"hybridj", solve<WithDerivatives<gsl_multiroot_fdfsolver_hybridj>>},
      {"newton", solve<WithDerivatives<gsl_multiroot_fdfsolver_newton>>},
      {"gnewton", solve<WithDerivatives<gsl_multiroot_fdfsolver_gnewton>>},
      {"hybrids", solve<WithoutDerivatives<gsl_multiroot_fsolver_hybrids>>},
      {"hybrid", solve<WithoutDerivatives<gsl_multiroot_fsolver_hybrid>>},
      {"dnewton", solve<WithoutDerivatives<gsl_multiroot_fsolver_dnewton>>},
      {"broyden", solve<WithoutDerivatives<gsl_multiroot_fsolver_broyden>>},
  };
  return solvers;
}

}  // namespace fastjoint::stage3
