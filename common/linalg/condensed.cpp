// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed.hpp"

#include <Eigen/Cholesky>
#include <cassert>

#include "common/errors.hpp"

namespace fastjoint::linalg {

Condensed::Condensed(Eigen::MatrixXd M, Eigen::Index n_interior) : n_(n_interior), M_(std::move(M)) {
  assert(M_.rows() == M_.cols() && n_ <= M_.rows());
  if (n_ == 0) return;
  Eigen::Ref<Eigen::MatrixXd> interior = M_.topLeftCorner(n_, n_);
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(interior).info() != Eigen::Success)
    throw NumericalError("the stiffness matrix of a cell of the plate is not positive definite");
  auto X = M_.bottomLeftCorner(n_boundary(), n_);
  L().adjoint().solveInPlace<Eigen::OnTheRight>(X);
  M_.bottomRightCorner(n_boundary(), n_boundary()).selfadjointView<Eigen::Lower>().rankUpdate(X, -1);
}

void Condensed::eliminate(Eigen::MatrixXd& interior, Eigen::MatrixXd& boundary) const {
  if (interior.size() == 0) return;
  L().solveInPlace(interior);
  boundary.noalias() -= X() * interior;
}

void Condensed::restore(Eigen::MatrixXd& interior, const Eigen::MatrixXd& boundary) const {
  if (interior.size() == 0) return;
  interior.noalias() -= X().transpose() * boundary;
  L().adjoint().solveInPlace(interior);
}

}  // namespace fastjoint::linalg
