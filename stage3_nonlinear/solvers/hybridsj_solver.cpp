// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/solvers/hybridsj_solver.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multiroots.h>
#include <gsl/gsl_vector.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

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

void iterate(gsl_multiroot_fdfsolver* solver, const RootOptions& options, Root& root) {
  for (int status = GSL_SUCCESS; status == GSL_SUCCESS; status = gsl_multiroot_fdfsolver_iterate(solver)) {
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

}  // namespace

void take_over_gsl_errors() { gsl_set_error_handler_off(); }

Root hybridsj_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options) {
  Payload payload{problem, nullptr};
  const std::size_t n = start.size();
  gsl_multiroot_function_fdf functions{residual, jacobian, both, n, &payload};
  const std::unique_ptr<gsl_multiroot_fdfsolver, decltype(&gsl_multiroot_fdfsolver_free)> solver(
      gsl_multiroot_fdfsolver_alloc(gsl_multiroot_fdfsolver_hybridsj, n), &gsl_multiroot_fdfsolver_free);
  if (!solver) throw std::bad_alloc();
  const gsl_vector_const_view x0 = gsl_vector_const_view_array(start.data(), n);
  Root root{start, VectorXd::Constant(start.size(), std::numeric_limits<double>::infinity())};
  if (gsl_multiroot_fdfsolver_set(solver.get(), &functions, &x0.vector) == GSL_SUCCESS)
    iterate(solver.get(), options, root);
  if (payload.thrown) std::rethrow_exception(payload.thrown);
  return root;
}

}  // namespace fastjoint::stage3
