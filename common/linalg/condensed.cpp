// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed.hpp"

#include <Eigen/Cholesky>
#include <cassert>

#include "common/errors.hpp"

namespace fastjoint::linalg {

Condensed::Condensed(Eigen::MatrixXd M, Eigen::Index n_inside) : n_(n_inside), M_(std::move(M)) {
  assert(M_.rows() == M_.cols() && n_ <= M_.rows());
  if (n_ == 0) return;
  Eigen::Ref<Eigen::MatrixXd> inside = M_.topLeftCorner(n_, n_);
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(inside).info() != Eigen::Success)
    throw NumericalError("the stiffness matrix of a cell of the plate is not positive definite");
  auto X = M_.bottomLeftCorner(n_outside(), n_);
  L().adjoint().solveInPlace<Eigen::OnTheRight>(X);
  M_.bottomRightCorner(n_outside(), n_outside()).selfadjointView<Eigen::Lower>().rankUpdate(X, -1);
}

void Condensed::eliminate(Eigen::MatrixXd& inside, Eigen::MatrixXd& outside) const {
  if (inside.size() == 0) return;
  L().solveInPlace(inside);
  outside.noalias() -= eliminated() * inside;
}

void Condensed::restore(Eigen::MatrixXd& inside, const Eigen::MatrixXd& outside) const {
  if (inside.size() == 0) return;
  inside.noalias() -= eliminated().transpose() * outside;
  L().adjoint().solveInPlace(inside);
}

}  // namespace fastjoint::linalg
