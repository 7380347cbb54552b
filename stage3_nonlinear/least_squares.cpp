// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/least_squares.hpp"

#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <exception>
#include <memory>
#include <new>

#include "stage3_nonlinear/gsl_callback.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct FreeWorkspace {
  void operator()(gsl_multifit_nlinear_workspace* w) const noexcept { gsl_multifit_nlinear_free(w); }
  void operator()(gsl_multifit_linear_workspace* w) const noexcept { gsl_multifit_linear_free(w); }
};

template <class Workspace>
std::unique_ptr<Workspace, FreeWorkspace> owned(Workspace* allocated) {
  if (allocated == nullptr) throw std::bad_alloc();
  return std::unique_ptr<Workspace, FreeWorkspace>(allocated);
}

/// The gradient of half the sum is J^T f, by the lengths of both a cosine; residuals of what the parameters make up
/// to rounding have no direction.
bool at_right_angles(const VectorXd& f, const MatrixXd& J, const VectorXd& x) {
  constexpr double small_cosine = 1e-5, rounding = 1e-12;
  const VectorXd lengths = J.colwise().norm().transpose();
  if (f.norm() <= rounding * lengths.dot(x.cwiseAbs())) return true;
  return ((J.transpose() * f).array().abs() <= small_cosine * f.norm() * lengths.array()).all();
}

}  // namespace

LeastSquares nonlinear_least_squares(const ResidualProblem& problem, const VectorXd& start) {
  constexpr std::size_t max_iterations = 500;
  constexpr double step_tolerance = 1e-13, gradient_tolerance = 0;
  Payload<ResidualProblem> payload{problem, nullptr};
  const auto n = static_cast<std::size_t>(problem.residual(start).size()), p = static_cast<std::size_t>(start.size());
  const auto parameters = gsl_multifit_nlinear_default_parameters();
  const auto solver = owned(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters, n, p));
  gsl_multifit_nlinear_fdf functions{
      evaluate<ResidualProblem>, differentiate<ResidualProblem>, nullptr, n, p, &payload, 0, 0, 0};
  const gsl_vector_const_view x0 = gsl_vector_const_view_array(start.data(), p);
  int why = 0;
  // A search that stands still at rounding is no failure, one that is not done is: statuses do not tell.
  if (gsl_multifit_nlinear_init(&x0.vector, &functions, solver.get()) == GSL_SUCCESS)
    gsl_multifit_nlinear_driver(max_iterations, step_tolerance, gradient_tolerance, 0, nullptr, nullptr, &why,
                                solver.get());
  if (payload.thrown) std::rethrow_exception(payload.thrown);
  LeastSquares result{view(solver->x), MatrixXd::Zero(start.size(), start.size()), false};
  const VectorXd f = problem.residual(result.x);
  const MatrixXd J = problem.jacobian(result.x);
  result.converged = at_right_angles(f, J, result.x);
  RowMajorXd inverse(start.size(), start.size());
  gsl_matrix_view covariance = gsl_matrix_view_array(inverse.data(), p, p);
  gsl_multifit_nlinear_covar(solver->J, 0, &covariance.matrix);
  result.inverse = inverse;
  return result;
}

LeastSquares linear_least_squares(const MatrixXd& J, const VectorXd& y) {
  const auto n = static_cast<std::size_t>(J.rows()), p = static_cast<std::size_t>(J.cols());
  const auto workspace = owned(gsl_multifit_linear_alloc(n, p));
  const RowMajorXd rows = J;
  const VectorXd weights = VectorXd::Ones(J.rows());  // with weights the covariance is that of unit variance
  LeastSquares result{VectorXd(J.cols()), {}, true};
  RowMajorXd inverse(J.cols(), J.cols());
  const gsl_matrix_const_view matrix = gsl_matrix_const_view_array(rows.data(), n, p);
  const gsl_vector_const_view right = gsl_vector_const_view_array(y.data(), n);
  const gsl_vector_const_view weight = gsl_vector_const_view_array(weights.data(), n);
  gsl_vector_view x = gsl_vector_view_array(result.x.data(), p);
  gsl_matrix_view covariance = gsl_matrix_view_array(inverse.data(), p, p);
  double sum = 0;
  gsl_multifit_wlinear(&matrix.matrix, &weight.vector, &right.vector, &x.vector, &covariance.matrix, &sum,
                       workspace.get());
  result.inverse = inverse;
  return result;
}

}  // namespace fastjoint::stage3
