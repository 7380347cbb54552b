// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/gsl_methods.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multiroots.h>
#include <gsl/gsl_vector.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "stage3_nonlinear/solvers/hybridsj_solver.hpp"
#include "stage3_nonlinear/solvers/newton_solver.hpp"

namespace fastjoint::bench {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using stage3::Root;
using stage3::RootOptions;
using stage3::RootProblem;

/// GSL's vectors and matrices as Eigen sees them.
auto view(const gsl_vector* v) {
  using Strided = Eigen::Map<VectorXd, 0, Eigen::InnerStride<>>;
  return Strided(v->data, v->size, Eigen::InnerStride<>(v->stride));
}
auto view(const gsl_matrix* m) {
  using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Strided = Eigen::Map<RowMajorXd, 0, Eigen::OuterStride<>>;
  return Strided(m->data, m->size1, m->size2, Eigen::OuterStride<>(m->tda));
}

/// What GSL carries through to the functions below.
struct Payload {
  const RootProblem& problem;
  std::exception_ptr thrown;  ///< for the caller to throw on: nothing may be thrown through C
};

/// Sets `out` to a function of x, as GSL calls it; what the function throws is kept.
template <class Function, class Out>
int evaluate(const Function& function, const gsl_vector* x, Payload& payload, Out* out) noexcept {
  try {
    return (view(out) = function(view(x))).allFinite() ? GSL_SUCCESS : GSL_EBADFUNC;
  } catch (...) {
    payload.thrown = std::current_exception();
    return GSL_EBADFUNC;
  }
}

int residual(const gsl_vector* x, void* params, gsl_vector* f) noexcept {
  auto& payload = *static_cast<Payload*>(params);
  return evaluate(payload.problem.residual, x, payload, f);
}

int jacobian(const gsl_vector* x, void* params, gsl_matrix* J) noexcept {
  auto& payload = *static_cast<Payload*>(params);
  return evaluate(payload.problem.jacobian, x, payload, J);
}

int both(const gsl_vector* x, void* params, gsl_vector* f, gsl_matrix* J) noexcept {
  const int evaluated = residual(x, params, f);
  return evaluated == GSL_SUCCESS ? jacobian(x, params, J) : evaluated;
}

/// GSL's two families behind one set of names.
template <const gsl_multiroot_fdfsolver_type*& type>
struct WithDerivatives {
  using Handle = gsl_multiroot_fdfsolver;
  gsl_multiroot_function_fdf functions;

  WithDerivatives(Payload& payload, std::size_t n) : functions{residual, jacobian, both, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fdfsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fdfsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fdfsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fdfsolver_iterate(solver); }
};

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
  Payload payload{problem, nullptr};
  const std::size_t n = start.size();
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
