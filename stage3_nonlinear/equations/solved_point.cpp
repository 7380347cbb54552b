// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/solved_point.hpp"

#include <limits>
#include <utility>

namespace fastjoint::stage3 {
namespace {

thread_local Index factorised = 0;

/// Largest change of a force by a unit vector of the null space with which the force still has a derivative.
constexpr double motion_of_force = 1e-6;

/// Coordinates slightly beyond the corners for planes under load that may be on one. Only piecewise linear laws have
/// corners other than that of their gap, at which the force is zero.
VectorXd beyond_corners(const JointEquations& equations, const ContactState& state, VectorXd c) {
  constexpr double beyond = 1 + 1e-9;
  const Index a = equations.n_directions();
  for (Index j = 0; j < equations.n_planes(); ++j) {
    const Contact& contact = equations.contacts[j];
    if (!state.F.segment(j * a, a).isZero(0) && contact.law->corners(contact.stiffness, contact.clearance))
      c.segment(j * a, a) *= beyond;
  }
  return c;
}

}  // namespace

SolvedPoint::SolvedPoint(JointEquations equations, double load_factor, VectorXd c)
    : equations_(std::move(equations)),
      load_factor_(load_factor),
      c_(std::move(c)),
      state_(contact_state(equations_, c_)),
      beyond_(contact_state(equations_, beyond_corners(equations_, state_, c_))) {
  factorise();
  if (equations_.has_friction && state_.F.isZero(0)) find_bearing_sides();
  check_ = check_tangent(equations_, beyond_, *factor_);
}

Index SolvedPoint::n_factorised() { return factorised; }

void SolvedPoint::factorise() {
  ++factorised;
  factor_ = std::make_unique<TangentFactor>(*equations_.system, beyond_);
}

/// Replaces the forces at no load, under which no rim bears, by those of a small load, which determine the sides on
/// which friction acts.
void SolvedPoint::find_bearing_sides() {
  constexpr int max_tries = 8;
  for (int i = 0; i < max_tries && equations_.has_cosine_friction; ++i) {
    const MatrixXd before = equations_.friction_matrix(beyond_.F);
    beyond_.F = slopes(-equations_.q).F;
    if (i > 0 && equations_.friction_matrix(beyond_.F) == before) return;
    for (Index at = 0; at < std::ssize(beyond_.parts); ++at) {
      const auto& [interface, row, friction] = equations_.interfaces[at];
      const MatrixXd by_force = interface->friction_by_force(beyond_.F.segment(row, interface->size()));
      if (by_force.size() > 0) beyond_.parts[at].dLambda = by_force * beyond_.parts[at].dF;
    }
    factorise();
  }
}

MatrixXd SolvedPoint::forces_by_c(Index rows) const {
  return beyond_.times(MatrixXd::Identity(rows, c_.size()), &Response::dF);
}

void SolvedPoint::find_rows_without_slope(Slopes& slopes) const {
  const MatrixXd F_free = beyond_.product(&Response::dF, factor_->free_motions()).topRows(slopes.F.rows());
  for (Index i = 0; i < F_free.rows(); ++i)
    if (F_free.row(i).norm() > motion_of_force) slopes.no_row.push_back(i);
}

/// If J is singular, slopes are found by least squares: columns with a remaining residual, and forces that change along
/// the null space, have no derivative.
Slopes SolvedPoint::slopes(const MatrixXd& residual) const {
  constexpr double max_residual = 1e-6;  // above the imbalance by the tolerance of the solver
  Slopes slopes;
  slopes.c = -(factor_->is_singular() ? factor_->solve_singular(residual) : factor_->solve(residual));
  slopes.F = beyond_.product(&Response::dF, slopes.c);
  if (!factor_->is_singular()) return slopes;
  const MatrixXd rest = factor_->times(slopes.c) + residual;
  for (Index i = 0; i < rest.cols(); ++i)
    if (rest.col(i).norm() > max_residual * residual.col(i).norm()) slopes.no_column.push_back(i);
  find_rows_without_slope(slopes);
  return slopes;
}

/// The transposed system has fewer right-hand sides than J: one for each force.
Slopes SolvedPoint::estimated_slopes() const {
  Slopes slopes;
  slopes.F = -factor_->estimate_transposed(forces_by_c(equations_.n_plane_rows()).transpose()).transpose();
  if (factor_->is_singular()) find_rows_without_slope(slopes);
  return slopes;
}

MatrixXd SolvedPoint::of_magnitudes(const Slopes& slopes) const {
  const Index a = beyond_.direction.rows(), n = beyond_.direction.cols();
  MatrixXd result = slopes.F.topRows(n);
  if (a > 1) {
    for (Index j = 0; j < result.rows(); ++j) {
      const auto block = slopes.F.middleRows(j * a, a);
      result.row(j) = beyond_.direction.col(j).transpose() * block;
      // Without load there is no direction, and the derivative of the magnitude is the norm of that of the vector.
      if (c_.segment(j * a, a).isZero(0)) result.row(j) = block.colwise().norm();
    }
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  for (const Index i : slopes.no_column) result.col(i).setConstant(none);
  for (const Index i : slopes.no_row)
    if (i < n * a) result.row(i / a).setConstant(none);
  return result;
}

}  // namespace fastjoint::stage3
