// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/tangent_check.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/condition.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Lu = Eigen::PartialPivLU<MatrixXd>;

/// From the signs of U's diagonal: the determinant itself may overflow.
bool is_negative(const Lu& lu) {
  const Index flips = (lu.matrixLU().diagonal().array() < 0).count();
  return (flips % 2 == 1) != (lu.permutationP().determinant() < 0);
}

Mechanism mechanism(const CondensedSystem& system, const ContactState& state, const MatrixXd& J, const VectorXd& scale,
                    std::vector<Index> open) {
  const Eigen::BDCSVD<MatrixXd> svd(J, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd c = svd.matrixV().rightCols(1).col(0).cwiseQuotient(scale);
  const VectorXd delta = state.times(MatrixXd::Identity(c.size(), c.size()), state.ddelta) * c;
  VectorXd motion = system.D_delta * delta;
  Index at = 0;
  motion.cwiseAbs().maxCoeff(&at);
  if (motion[at] != 0) motion /= motion[at];
  return {std::move(open), motion};
}

}  // namespace

VectorXd scale_columns(MatrixXd& A) {
  VectorXd scale(A.cols());
  for (Index j = 0; j < A.cols(); ++j) {
    scale[j] = std::max(A.col(j).cwiseAbs().maxCoeff(), 1e-300);
    A.col(j) /= scale[j];
  }
  return scale;
}

std::optional<double> self_locking(const CondensedSystem& system, const VectorXd& F) {
  if (!system.has_friction()) return std::nullopt;
  const MatrixXd H = system.friction_matrix(F);
  // No eigenvalue exceeds a norm.
  if (std::min(H.cwiseAbs().rowwise().sum().maxCoeff(), H.cwiseAbs().colwise().sum().maxCoeff()) < 1)
    return std::nullopt;
  constexpr double real = 1e-9;  // imaginary part of a real eigenvalue, by rounding
  double largest = 0;
  const Eigen::VectorXcd values = Eigen::EigenSolver<MatrixXd>(-H, false).eigenvalues();
  for (const auto& value : values)
    if (std::abs(value.imag()) <= real * std::abs(value)) largest = std::max(largest, value.real());
  if (!(largest >= 1)) return std::nullopt;
  return 1 / largest;
}

TangentCheck check_tangent(const JointEquations& equations, const ContactState& state) {
  TangentCheck check;
  MatrixXd J = tangent(equations.system, state);
  const VectorXd scale = scale_columns(J);
  const Lu lu(J);
  std::vector<Index> open;
  for (Index j = 0; j < state.dF.along.size(); ++j)
    if (state.dF.along[j] == 0) open.push_back(j);
  if (!open.empty() && !(reciprocal_condition(lu) > singular_tangent)) {
    check.mechanism = mechanism(equations.system, state, J, scale, std::move(open));
    return check;
  }
  if (equations.system.has_friction() || equations.metric.size() == 0) check.turned = is_negative(lu);
  check.locking = self_locking(equations.system, state.F);
  return check;
}

std::vector<Index> planes_that_may_snap(const JointEquations& equations) {
  std::vector<Index> falling;
  MatrixXd S = equations.system.S_ud;
  const Index n = equations.n_planes(), a = equations.n_directions();
  for (Index j = 0; j < n; ++j) {
    const Law& law = *equations.contacts[static_cast<std::size_t>(j)].law;
    if (law.rises()) continue;
    falling.push_back(j);
    for (Index d = 0; d < a; ++d) S(j * a + d, j * a + d) += law.least_slope();
  }
  if (falling.empty() || Eigen::LLT<MatrixXd>(S).info() == Eigen::Success) return {};
  return falling;
}

}  // namespace fastjoint::stage3
