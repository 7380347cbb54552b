// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multiroots.h>
#include <gsl/gsl_vector.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "stage3_nonlinear/solvers/root.hpp"

/// GSL's solvers of n equations as SolveFunction, for files that link GSL.
namespace fastjoint::stage3::gsl {

/// GSL's vectors and matrices as Eigen sees them.
inline auto view(const gsl_vector* v) {
  using Strided = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>;
  return Strided(v->data, v->size, Eigen::InnerStride<>(v->stride));
}
inline auto view(const gsl_matrix* m) {
  using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Strided = Eigen::Map<RowMajorXd, 0, Eigen::OuterStride<>>;
  return Strided(m->data, m->size1, m->size2, Eigen::OuterStride<>(m->tda));
}

/// The problem as GSL passes it to the functions below, and the exception that they have thrown.
struct Payload {
  const RootProblem& problem;
  std::exception_ptr thrown;  ///< rethrown by the caller: an exception must not pass through C
};

/// Sets `out` to a function of x for GSL; an exception of the function is kept in the payload.
template <class Function, class Out>
int evaluate(Function RootProblem::*function, const gsl_vector* x, void* payload, Out* out) noexcept {
  auto& [problem, thrown] = *static_cast<Payload*>(payload);
  try {
    return (view(out) = (problem.*function)(view(x))).allFinite() ? GSL_SUCCESS : GSL_EBADFUNC;
  } catch (...) {
    thrown = std::current_exception();
    return GSL_EBADFUNC;
  }
}
inline int residual(const gsl_vector* x, void* payload, gsl_vector* f) noexcept {
  return evaluate(&RootProblem::residual, x, payload, f);
}
inline int jacobian(const gsl_vector* x, void* payload, gsl_matrix* J) noexcept {
  return evaluate(&RootProblem::jacobian, x, payload, J);
}
inline int both(const gsl_vector* x, void* payload, gsl_vector* f, gsl_matrix* J) noexcept {
  const int evaluated = residual(x, payload, f);
  return evaluated == GSL_SUCCESS ? jacobian(x, payload, J) : evaluated;
}

/// Solvers that use the Jacobian; another family would have the same members.
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

template <class Family>
Root solve(const RootProblem& problem, const Eigen::VectorXd& start, const RootOptions& options) {
  const auto infinite = Eigen::VectorXd::Constant(start.size(), std::numeric_limits<double>::infinity());
  Payload payload{problem, nullptr};
  const std::size_t n = start.size();
  Family family(payload, n);
  const std::unique_ptr<typename Family::Handle, decltype(&Family::free)> solver(Family::alloc(n), &Family::free);
  if (!solver) throw std::bad_alloc();
  const gsl_vector_const_view x0 = gsl_vector_const_view_array(start.data(), n);
  Root root{start, infinite};
  root.ending = Ending::no_progress;
  int status = family.set(solver.get(), &x0.vector);
  for (; status == GSL_SUCCESS; status = Family::iterate(solver.get())) {
    root.x = view(solver->x);
    root.residual = view(solver->f);
    if (!root.residual.allFinite()) {  // at the start, which GSL does not check
      root.residual = infinite;
      root.ending = Ending::not_finite;
      break;
    }
    if (options.report) options.report(root);
    root.converged = root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance;
    if (root.converged || root.iterations == options.max_iterations) {
      root.ending = root.converged ? Ending::converged : Ending::max_iterations;
      break;
    }
    ++root.iterations;
  }
  if (payload.thrown) std::rethrow_exception(payload.thrown);
  if (status == GSL_EBADFUNC) root.ending = Ending::not_finite;
  return root;
}

}  // namespace fastjoint::stage3::gsl
