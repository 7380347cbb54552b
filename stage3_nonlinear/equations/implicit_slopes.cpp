// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/implicit_slopes.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>

#include "stage3_nonlinear/equations/condition.hpp"
#include "stage3_nonlinear/equations/tangent_check.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Least squares where J is singular: what is left of the right-hand side has no solution near, and forces that the
/// free motions N of the unknowns change have no derivative.
Slopes solve_singular(const MatrixXd& J, const MatrixXd& F_c, const MatrixXd& rhs) {
  constexpr double left = 1e-6;  // beyond what the solver's tolerance leaves out of balance
  Eigen::BDCSVD<MatrixXd> svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(singular_tangent);
  const MatrixXd dc = svd.solve(rhs);
  Slopes slopes{F_c * dc, {}, {}};
  const MatrixXd rest = J * dc - rhs;
  for (Index i = 0; i < rhs.cols(); ++i)
    if (rest.col(i).norm() > left * rhs.col(i).norm()) slopes.no_column.push_back(i);
  const MatrixXd F_free = F_c * svd.matrixV().rightCols(J.cols() - svd.rank());
  for (Index i = 0; i < F_free.rows(); ++i)
    if (F_free.row(i).norm() > left) slopes.no_row.push_back(i);
  return slopes;
}

}  // namespace

VectorXd coordinates(const std::vector<Contact>& contacts, const VectorXd& F, const VectorXd& delta) {
  const Index a = F.size() / contacts.size();
  VectorXd c(F.size());
  for (Index j = 0; j < c.size() / a; ++j) {
    const Contact& contact = contacts[j];
    c.segment(j * a, a) = contact.stiffness * delta.segment(j * a, a);
    if (contact.law->rises()) c.segment(j * a, a) += F.segment(j * a, a);
  }
  return c;
}

Slopes implicit_slopes(const CondensedSystem& system, const ContactState& state, const MatrixXd& residual) {
  MatrixXd J = tangent(system, state);
  MatrixXd F_c = state.times(MatrixXd::Identity(J.rows(), J.rows()), state.dF);
  const VectorXd scale = scale_columns(J);
  F_c *= scale.cwiseInverse().asDiagonal();
  const Eigen::PartialPivLU<MatrixXd> lu(J);
  if (least_stretch(lu, J) > singular_tangent) return {-F_c * lu.solve(residual), {}, {}};
  return solve_singular(J, F_c, -residual);
}

void bear(const JointEquations& equations, ContactState& state) {
  constexpr int most_tries = 8;
  const CondensedSystem& system = equations.system;
  for (int i = 0; i < most_tries; ++i) {
    const VectorXd before = system.E * state.F;
    state.F = implicit_slopes(system, state, -system.q).F;
    if (i > 0 && ((system.E * state.F).array() * before.array() >= 0).all()) return;
  }
}

MatrixXd of_amounts(const Slopes& slopes, const ContactState& state, const VectorXd& c) {
  const Index a = state.direction.rows();
  MatrixXd result = slopes.F;
  if (a > 1) {
    result.resize(state.direction.cols(), slopes.F.cols());
    for (Index j = 0; j < result.rows(); ++j) {
      const auto block = slopes.F.middleRows(j * a, a);
      // Without load there is no direction; the amount then grows whatever the direction is.
      if (c.segment(j * a, a).isZero(0)) {
        result.row(j) = block.colwise().norm();
      } else {
        result.row(j) = state.direction.col(j).transpose() * block;
      }
    }
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  for (const Index i : slopes.no_column) result.col(i).setConstant(none);
  for (const Index i : slopes.no_row) result.row(i / a).setConstant(none);
  return result;
}

}  // namespace fastjoint::stage3
