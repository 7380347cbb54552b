// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/rim_problem.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double rim_rounding = 1e-14;
constexpr int max_pressure_steps = 100, max_step_halvings = 20;

/// Stiffness of the springs between the rims, force / length: that of the tail, or more if a wave asks for it.
double contact_stiffness(const ShortWaves& waves, double area, double k) {
  MatrixXd compliance = waves.M / area;
  compliance.diagonal().head(waves.n_long).array() += 1 / k;
  constexpr int max_tries = 200;
  constexpr double factor = 1.25, margin = 1 + 1e-7;  // over the stiffness at which a wave would have no compliance
  double stiffness = area / waves.tail;
  const auto is_enough = [&] {
    MatrixXd rest = compliance;
    rest.diagonal().array() -= margin / stiffness;
    return matrices::is_positive_definite(rest);
  };
  for (int tries = 0; !is_enough(); ++tries, stiffness *= factor)
    if (tries > max_tries) throw NumericalError("the waves of a rim of contact have no positive compliance");
  return stiffness;
}

}  // namespace

RimProblem::RimProblem(std::shared_ptr<const ShortWaves> waves, double area, double k, double gap, double mu,
                       std::shared_ptr<const RimProblem> compared)
    : waves_(std::move(waves)),
      compared_(std::move(compared)),
      area_(area),
      k_(k),
      contact_(waves_->pressures, contact_stiffness(*waves_, area, k), gap, mu),
      is_diagonal_(waves_->M.isDiagonal(1e-12)),
      diagonal_(VectorXd::Constant(waves_->n, -1 / contact_.stiffness())) {
  diagonal_.head(n_long()).array() += 1 / k;
  if (is_diagonal_) {
    M_tau_ = waves_->M_tau.sparseView();
    root_ = (waves_->M.diagonal() / area + diagonal_).cwiseSqrt();
  } else {
    MatrixXd M = waves_->M / area;
    M.diagonal() += diagonal_;
    root_ = M.llt().matrixL();
  }
}

VectorXd RimProblem::against_sheet(const VectorXd& w, const VectorXd& pressure, const VectorXd& shear) const {
  const ShortWaves& a = *waves_;
  VectorXd result = w + a.disk_compliance.cwiseProduct(pressure) - pressure / modulus();
  if (shear.size() > 0) result += a.disk_by_shear * shear;
  if (a.is_empty()) return result;
  // The sheet has all of the short waves' compliance.
  result.head(a.n_long) -=
      a.D.topLeftCorner(a.n_long, a.n) * (1 - a.part.array().sqrt()).matrix().cwiseProduct(pressure);
  const auto rows = a.D.middleRows(a.n_long, a.n - a.n_long);
  result.tail(rows.rows()) = -(rows.leftCols(a.n) * pressure);
  if (shear.size() > 0) result.tail(rows.rows()) -= rows.rightCols(a.n_shears) * shear;
  return result;
}

RimProblem RimProblem::with(double gap, double mu) const {
  RimProblem other = *this;
  other.contact_ = contact_.with(gap, mu);
  other.is_solved_ = false;
  if (compared_) other.compared_ = std::make_shared<const RimProblem>(compared_->with(gap, mu));
  return other;
}

VectorXd RimProblem::forward(const VectorXd& s) const {
  if (is_diagonal_) return root_.col(0).cwiseProduct(s);
  return root_.triangularView<Eigen::Lower>() * s;
}

VectorXd RimProblem::back(const VectorXd& f) const {
  if (is_diagonal_) return root_.col(0).cwiseProduct(f);
  return root_.triangularView<Eigen::Lower>().transpose() * f;
}

MatrixXd RimProblem::solve_root(const MatrixXd& x) const {
  if (is_diagonal_) return root_.col(0).cwiseInverse().asDiagonal() * x;
  return root_.triangularView<Eigen::Lower>().solve(x);
}

MatrixXd RimProblem::curvature(const Touching& touching) const {
  MatrixXd H = contact_.stiffness() * touching.gram;
  if (is_diagonal_) {
    H.array().colwise() *= root_.col(0).array();
    H.array().rowwise() *= root_.col(0).transpose().array();
  } else {
    H = (root_.triangularView<Eigen::Lower>().transpose() * H).eval() * root_.triangularView<Eigen::Lower>();
  }
  H.diagonal().array() += 1;
  return H;
}

RimProblem::State RimProblem::frictionless_state(const VectorXd& b, VectorXd s) const {
  State at;
  at.w = b + forward(s);
  at.s = std::move(s);
  at.touching = contact_.touching(at.w);
  at.forces = contact_.forces(at.touching, at.w);
  at.scaled_forces = back(at.forces);
  return at;
}

/// Newton's method for s: s + root^T f(b + root s) is the gradient of a convex function with second derivatives of at
/// least 1. A step is halved until the slope along it is at most a small fraction of the slope at its start.
RimProblem::State RimProblem::solve_frictionless(const VectorXd& b, const VectorXd& w) const {
  const double by_gap = back(contact_.stiffness() * contact_.gap() * VectorXd::Unit(b.size(), 0)).norm();
  State at = frictionless_state(b, solve_root(w - b));
  for (int i = 0; i < max_pressure_steps; ++i) {
    const VectorXd gradient = at.s + at.scaled_forces;
    const double before = gradient.norm(), scale = at.s.norm() + at.scaled_forces.norm() + by_gap;
    if (before <= rim_rounding * scale) break;
    const VectorXd step = -curvature(at.touching).llt().solve(gradient);
    const double slope = gradient.dot(step);
    double length = 1;
    State there = frictionless_state(b, at.s + step);
    constexpr double max_slope = 0.1;
    for (int j = 0; j < max_step_halvings && (there.s + there.scaled_forces).dot(step) > -max_slope * slope; ++j) {
      length /= 2;
      there = frictionless_state(b, at.s + length * step);
    }
    constexpr double near = 1e-11;  // the residual may be rim_rounding only
    if (before <= near * scale && (there.s + there.scaled_forces).norm() > 0.5 * before) break;
    at = std::move(there);
  }
  return at;
}

RimProblem::State RimProblem::state_with_friction(const VectorXd& b, VectorXd w) const {
  State at;
  at.w = std::move(w);
  at.touching = contact_.touching(at.w);
  at.forces = contact_.forces(at.touching, at.w);
  at.friction = rim_friction(contact_, at.touching, at.w);
  at.residual = at.w - b + (waves_->M * at.forces + waves_->M_tau * at.friction.forces) / area_;
  at.residual += diagonal_.cwiseProduct(at.forces);
  return at;
}

MatrixXd RimProblem::jacobian(const Touching& touching, const RimFriction& friction) const {
  MatrixXd J;
  if (is_diagonal_) {
    J = modulus() * (M_tau_ * friction.slopes);
    J += modulus() * waves_->M.diagonal().asDiagonal() * touching.gram;
  } else {
    J = modulus() * waves_->M_tau * friction.slopes;
    J += modulus() * waves_->M * touching.gram;
  }
  J += contact_.stiffness() * diagonal_.asDiagonal() * touching.gram;
  J.diagonal().array() += 1;
  return J;
}

/// Newton's method with steps that are halved until the residual falls. A residual that is nearly rim_rounding falls by
/// whole steps or not at all.
bool RimProblem::solve_with_friction(const VectorXd& b, State& at) const {
  constexpr double near = 1e-12;
  const auto scale = [&] { return at.w.norm() + b.norm() + std::abs(contact_.gap()); };
  for (int i = 0; i < max_pressure_steps; ++i) {
    const double before = at.residual.norm();
    if (before <= rim_rounding * scale()) return true;
    const VectorXd step = -matrices::Lu(jacobian(at.touching, at.friction)).solve(at.residual);
    const int halvings = before > near * scale() ? max_step_halvings : 0;
    double length = 1;
    State there = state_with_friction(b, at.w + step);
    const auto falls = [&] { return there.residual.norm() < (1 - 0.1 * length) * before; };
    for (int j = 0; j < halvings && !falls(); ++j) {
      length /= 2;
      there = state_with_friction(b, at.w + length * step);
    }
    if (!falls()) break;
    at = std::move(there);
  }
  return at.residual.norm() <= near * scale();
}

/// Solves for coefficients of friction that grow from 0 to that of the rim, each from the solution before.
bool RimProblem::solve_by_more_friction(const VectorXd& b, VectorXd w, State& at) const {
  constexpr double least = 1.0 / 32;
  for (double reached = 0, step = 0.25; reached < 1;) {
    const double next = std::min(reached + step, 1.0);
    const RimProblem part = with(contact_.gap(), next * contact_.mu());
    State there = part.state_with_friction(b, w);
    if (part.solve_with_friction(b, there)) {
      w = there.w;
      reached = next;
      step *= 2;
    } else {
      step /= 2;
      if (step < least) return false;
    }
  }
  at = state_with_friction(b, w);
  return solve_with_friction(b, at);
}

const RimSolution& RimProblem::solve(const VectorXd& c) const {
  if (!is_solved_at(c)) {
    const bool predicts = last_c_.size() > 0 && last_.converged && last_.w_by_c.size() > 0;
    solve_from(predicts ? VectorXd(last_.w + last_.w_by_c * (c - last_c_)) : VectorXd(), c);
  }
  if (last_.w_by_c.size() == 0) add_derivatives(last_);
  return last_;
}

const RimSolution& RimProblem::solve_compared(const VectorXd& c) const {
  if (!compared_->is_solved_at(c)) {
    VectorXd start = VectorXd::Zero(compared_->waves_->n);
    const Index both = std::min(start.size(), waves_->n);
    start.head(both) = solve(c).w.head(both);
    compared_->solve_from(start, c);
  }
  return compared_->last_;
}

void RimProblem::solve_from(const VectorXd& start, const VectorXd& c) const {
  last_ = solution(c, start);
  last_c_ = c;
  is_solved_ = true;
}

RimSolution RimProblem::contact_at(VectorXd w) const {
  Touching touching = contact_.touching(w);
  VectorXd forces = contact_.forces(touching, w);
  RimFriction friction = rim_friction(contact_, touching, w);
  return {std::move(w), std::move(touching), std::move(forces), std::move(friction)};
}

RimSolution RimProblem::solution(const VectorXd& c, const VectorXd& start) const {
  VectorXd b = VectorXd::Zero(waves_->n);
  b.head(n_long()) = c / k_;
  State at;
  bool converged = true;
  if (contact_.mu() > 0) {
    if (start.size() > 0) at = state_with_friction(b, start);
    if (start.size() == 0 || !solve_with_friction(b, at)) {
      const VectorXd w = solve_frictionless(b, b).w;
      at = state_with_friction(b, w);
      converged = solve_with_friction(b, at) || solve_by_more_friction(b, w, at);
    }
  } else {
    at = solve_frictionless(b, start.size() > 0 ? start : b);
  }
  return {std::move(at.w), std::move(at.touching), std::move(at.forces), std::move(at.friction), converged};
}

void RimProblem::add_derivatives(RimSolution& its) const {
  MatrixXd rhs = MatrixXd::Zero(waves_->n, n_long() + 1);
  rhs.topLeftCorner(n_long(), n_long()).diagonal().setConstant(1 / k_);
  const bool touches = !its.touching.arcs.empty();
  if (contact_.mu() > 0) {
    if (its.friction.slips) rhs.rightCols(1) = -waves_->M_tau * its.friction.forces / (area_ * contact_.mu());
    if (touches) rhs = matrices::Lu(jacobian(its.touching, its.friction)).solve(std::move(rhs));
  } else if (touches) {
    rhs = solve_root(rhs);
    curvature(its.touching).llt().solveInPlace(rhs);
    for (auto column : rhs.colwise()) column = forward(column);
  }
  its.w_by_c = rhs.leftCols(n_long());
  its.w_by_mu = rhs.rightCols(1);
}

}  // namespace fastjoint::stage3
