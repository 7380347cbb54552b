// SPDX-License-Identifier: GPL-3.0-or-later
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multiroots.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "stage3_nonlinear/solvers/root.hpp"

namespace fastjoint::stage3 {
namespace {

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

/// The problem as GSL hands it to the functions below, and what they have thrown.
struct Payload {
  const RootProblem& problem;
  std::exception_ptr thrown;  ///< for the caller to throw on: nothing may be thrown through C
};

/// Sets `out` to a function of x, as GSL calls it; what the function throws is kept in the payload.
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
int residual(const gsl_vector* x, void* payload, gsl_vector* f) noexcept {
  return evaluate(&RootProblem::residual, x, payload, f);
}
int jacobian(const gsl_vector* x, void* payload, gsl_matrix* J) noexcept {
  return evaluate(&RootProblem::jacobian, x, payload, J);
}
int both(const gsl_vector* x, void* payload, gsl_vector* f, gsl_matrix* J) noexcept {
  const int evaluated = residual(x, payload, f);
  return evaluated == GSL_SUCCESS ? jacobian(x, payload, J) : evaluated;
}

}  // namespace

void take_over_gsl_errors() { gsl_set_error_handler_off(); }

Root hybridsj_root(const RootProblem& problem, const VectorXd& start, const RootOptions& options) {
  const auto infinite = VectorXd::Constant(start.size(), std::numeric_limits<double>::infinity());
  const std::size_t n = start.size();
  Payload payload{problem, nullptr};
  gsl_multiroot_function_fdf functions{residual, jacobian, both, n, &payload};
  const std::unique_ptr<gsl_multiroot_fdfsolver, decltype(&gsl_multiroot_fdfsolver_free)> solver(
      gsl_multiroot_fdfsolver_alloc(gsl_multiroot_fdfsolver_hybridsj, n), &gsl_multiroot_fdfsolver_free);
  if (!solver) throw std::bad_alloc();
  const gsl_vector_const_view x0 = gsl_vector_const_view_array(start.data(), n);
  Root root{start, infinite};
  for (int status = gsl_multiroot_fdfsolver_set(solver.get(), &functions, &x0.vector); status == GSL_SUCCESS;
       status = gsl_multiroot_fdfsolver_iterate(solver.get())) {
    root.x = view(solver->x);
    root.residual = view(solver->f);
    if (!root.residual.allFinite()) {  // at the start, where GSL does not ask
      root.residual = infinite;
      break;
    }
    root.converged = root.residual.lpNorm<Eigen::Infinity>() <= options.tolerance;
    if (root.converged || root.iterations == options.max_iterations) break;
    ++root.iterations;
  }
  if (payload.thrown) std::rethrow_exception(payload.thrown);
  return root;
}

}  // namespace fastjoint::stage3
