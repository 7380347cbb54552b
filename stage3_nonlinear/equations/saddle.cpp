// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/saddle.hpp"

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>

#include "stage3_nonlinear/equations/condition.hpp"

namespace fastjoint::stage3 {
namespace {

/// Stage 2's rounding leaves a floating sheet about 1e-12 of its stiffness; a long chain of fasteners needs
/// 1e-6. A sheet may be as much softer than its neighbours as it likes: its rows are scaled by its own stiffness.
constexpr double singular = 1e-10;

Eigen::VectorXd scales(const Eigen::MatrixXd& S, const Eigen::VectorXd& own, const Eigen::MatrixXd& B) {
  const double largest = S.diagonal().maxCoeff();
  Eigen::VectorXd scale(S.rows() + B.cols());
  for (Eigen::Index i = 0; i < S.rows(); ++i)
    scale[i] = 1 / std::sqrt(S(i, i) > singular * own[i] ? S(i, i) : own[i] > 0 ? own[i] : largest > 0 ? largest : 1.0);
  for (Eigen::Index j = 0; j < B.cols(); ++j)
    scale[S.rows() + j] = 1 / B.col(j).cwiseAbs().cwiseProduct(scale.head(S.rows())).maxCoeff();
  return scale;
}

}  // namespace

Saddle::Saddle(const Eigen::MatrixXd& S, const Eigen::VectorXd& own, const Eigen::MatrixXd& B)
    : scale_(scales(S, own, B)), matrix_(S.rows() + B.cols(), S.rows() + B.cols()), n_displacements_(S.rows()) {
  assert(S.rows() == S.cols() && S.rows() == B.rows());
  matrix_ << S, B, B.transpose(), Eigen::MatrixXd::Zero(B.cols(), B.cols());
  matrix_ = scale_.asDiagonal() * matrix_ * scale_.asDiagonal();
  lu_.compute(matrix_);
}

bool Saddle::is_regular() const { return reciprocal_condition(lu_) > singular; }

Eigen::MatrixXd Saddle::solve(const Eigen::MatrixXd& rhs) const {
  return scale_.asDiagonal() * lu_.solve(scale_.asDiagonal() * rhs);
}

Eigen::MatrixXd Saddle::free_motions() const {
  // A little above the limit of is_regular, whose rcond is an estimate in another norm.
  constexpr double small = 1e3 * singular;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix_);
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseAbs();
  Eigen::MatrixXd motions(n_displacements_, 0);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values[i] > small * values.maxCoeff()) continue;
    const Eigen::VectorXd D =
        scale_.head(n_displacements_).cwiseProduct(eigen.eigenvectors().col(i).head(n_displacements_));
    motions.conservativeResize(Eigen::NoChange, motions.cols() + 1);
    motions.rightCols(1) = D / D.cwiseAbs().maxCoeff();
  }
  return motions;
}

}  // namespace fastjoint::stage3
