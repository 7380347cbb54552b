// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/gsl_solver.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multiroots.h>

#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "stage3_nonlinear/c_callback.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;
using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
// GSL's solver works on blocks of its own, whose rows lie one after the other.
using VectorView = Eigen::Map<VectorXd>;
using MatrixView = Eigen::Map<RowMajorXd, 0, Eigen::OuterStride<>>;

/// What GSL carries through to the functions below.
struct Payload {
  const RootProblem& problem;
  std::exception_ptr thrown;
};

/// GSL's status of a body that says whether what it evaluated is finite.
template <class Body>
int status(Payload& payload, Body body) noexcept {
  return without_throwing(payload.thrown, body) ? GSL_SUCCESS : GSL_EBADFUNC;
}

VectorXd copied(const gsl_vector* v) {
  return Eigen::Map<const VectorXd, 0, Eigen::InnerStride<>>(
      v->data, static_cast<Eigen::Index>(v->size), Eigen::InnerStride<>(static_cast<Eigen::Index>(v->stride)));
}

int evaluate(const gsl_vector* x, void* params, gsl_vector* f) noexcept {
  auto& payload = *static_cast<Payload*>(params);
  return status(payload, [&] {
    const VectorXd value = payload.problem.residual(copied(x));
    VectorView(f->data, value.size()) = value;
    return value.allFinite();
  });
}

int differentiate(const gsl_vector* x, void* params, gsl_matrix* J) noexcept {
  auto& payload = *static_cast<Payload*>(params);
  return status(payload, [&] {
    const Eigen::MatrixXd value = payload.problem.jacobian(copied(x));
    MatrixView(J->data, value.rows(), value.cols(), Eigen::OuterStride<>(static_cast<Eigen::Index>(J->tda))) = value;
    return value.allFinite();
  });
}

int evaluate_both(const gsl_vector* x, void* params, gsl_vector* f, gsl_matrix* J) noexcept {
  const int evaluated = evaluate(x, params, f);
  return evaluated == GSL_SUCCESS ? differentiate(x, params, J) : evaluated;
}

/// GSL's two families behind one set of names.
template <const gsl_multiroot_fdfsolver_type*& type>
struct WithDerivatives {
  using Handle = gsl_multiroot_fdfsolver;
  gsl_multiroot_function_fdf functions;

  WithDerivatives(Payload& payload, std::size_t n) : functions{evaluate, differentiate, evaluate_both, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fdfsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fdfsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fdfsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fdfsolver_iterate(solver); }
};

template <const gsl_multiroot_fsolver_type*& type>
struct WithoutDerivatives {
  using Handle = gsl_multiroot_fsolver;
  gsl_multiroot_function functions;

  WithoutDerivatives(Payload& payload, std::size_t n) : functions{evaluate, n, &payload} {}
  static Handle* alloc(std::size_t n) { return gsl_multiroot_fsolver_alloc(type, n); }
  static void free(Handle* solver) { gsl_multiroot_fsolver_free(solver); }
  int set(Handle* solver, const gsl_vector* x) { return gsl_multiroot_fsolver_set(solver, &functions, x); }
  static int iterate(Handle* solver) { return gsl_multiroot_fsolver_iterate(solver); }
};

template <class Family>
void iterate(typename Family::Handle* solver, const RootOptions& options, Root& root) {
  for (int status = GSL_SUCCESS; status == GSL_SUCCESS; status = Family::iterate(solver)) {
    root.x = copied(solver->x);
    root.residual = copied(solver->f);
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
