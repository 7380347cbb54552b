// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

#include <Eigen/Core>
#include <exception>

namespace fastjoint::stage3 {

using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// GSL's vectors and matrices as Eigen sees them.
inline auto view(const gsl_vector* v) {
  using Strided = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>;
  return Strided(v->data, static_cast<Eigen::Index>(v->size),
                 Eigen::InnerStride<>(static_cast<Eigen::Index>(v->stride)));
}
inline auto view(const gsl_matrix* m) {
  using Strided = Eigen::Map<RowMajorXd, 0, Eigen::OuterStride<>>;
  return Strided(m->data, static_cast<Eigen::Index>(m->size1), static_cast<Eigen::Index>(m->size2),
                 Eigen::OuterStride<>(static_cast<Eigen::Index>(m->tda)));
}

/// What GSL carries through to the functions below: a problem with `residual` (n) -> (m) and `jacobian` (n) -> (m, n).
template <class Problem>
struct Payload {
  const Problem& problem;
  std::exception_ptr thrown;  ///< for the caller to throw on: nothing may be thrown through C
};

/// GSL's status of a body that says whether what it evaluated is finite; what it throws is kept.
template <class Problem, class Body>
int status(Payload<Problem>& payload, Body body) noexcept {
  try {
    return body() ? GSL_SUCCESS : GSL_EBADFUNC;
  } catch (...) {
    payload.thrown = std::current_exception();
    return GSL_EBADFUNC;
  }
}

/// f = residual(x), as GSL calls it.
template <class Problem>
int evaluate(const gsl_vector* x, void* params, gsl_vector* f) noexcept {
  auto& payload = *static_cast<Payload<Problem>*>(params);
  return status(payload, [&] { return (view(f) = payload.problem.residual(view(x))).allFinite(); });
}

/// J = jacobian(x), as GSL calls it.
template <class Problem>
int differentiate(const gsl_vector* x, void* params, gsl_matrix* J) noexcept {
  auto& payload = *static_cast<Payload<Problem>*>(params);
  return status(payload, [&] { return (view(J) = payload.problem.jacobian(view(x))).allFinite(); });
}

}  // namespace fastjoint::stage3
