// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/rim_problem.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <utility>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double rounding = 1e-14;
constexpr int most_steps = 100, most_halvings = 40;

}  // namespace

double contact_stiffness(const formats::ContactRim& rim, const ShortWaves& waves, double k) {
  if (!rim.disk.is_given()) return rim.modulus * rim.area;
  MatrixXd compliance = waves.M / rim.area;
  compliance.diagonal().head(waves.n_long).array() += 1 / k;
  constexpr double enough = 2, margin = 1.5;  // times what would leave a wave no compliance
  double stiffness = enough * rim.area / waves.least_yield;
  const auto rest = [&](double yield) {
    MatrixXd less = compliance;
    less.diagonal().array() -= yield;
    return less;
  };
  while (!matrices::is_positive_definite(rest(margin / stiffness))) stiffness *= enough;
  return stiffness;
}

RimProblem::RimProblem(RimContact contact, std::shared_ptr<const ShortWaves> waves, double area, double k)
    : contact_(std::move(contact)),
      waves_(std::move(waves)),
      area_(area),
      k_(k),
      is_diagonal_(waves_->M.isDiagonal(1e-12)),
      more_(VectorXd::Constant(waves_->n, waves_->yield.size() > 0 ? -1 / contact_.stiffness() : 0)) {
  more_.head(n_long()).array() += 1 / k;
  if (is_diagonal_) {
    M_tau_ = waves_->M_tau.sparseView();
    root_ = (waves_->M.diagonal() / area + more_).cwiseSqrt();
  } else {
    MatrixXd M = waves_->M / area;
    M.diagonal() += more_;
    root_ = M.llt().matrixL();
  }
}

VectorXd RimProblem::against_sheet(const VectorXd& w, const VectorXd& pressure, const VectorXd& shear) const {
  if (waves_->yield.size() == 0) return w;
  const VectorXd by_pressure = waves_->yield.cwiseProduct(pressure) - pressure / modulus();
  if (shear.size() == 0) return w + by_pressure;
  return w + by_pressure + waves_->yield_by_shear * shear;
}

RimProblem RimProblem::with(double gap, double mu) const {
  RimProblem other = *this;
  other.contact_ = contact_.with(gap, mu);
  other.is_solved_ = false;
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
  MatrixXd H = contact_.stiffness() * touching.share;
  if (is_diagonal_) {
    H.array().colwise() *= root_.col(0).array();
    H.array().rowwise() *= root_.col(0).transpose().array();
  } else {
    H = (root_.triangularView<Eigen::Lower>().transpose() * H).eval() * root_.triangularView<Eigen::Lower>();
  }
  H.diagonal().array() += 1;
  return H;
}

RimProblem::State RimProblem::frictionless(const VectorXd& b, VectorXd s) const {
  State at;
  at.w = b + forward(s);
  at.s = std::move(s);
  at.touching = contact_.touching(at.w);
  at.forces = contact_.forces(at.touching, at.w);
  at.pushed = back(at.forces);
  return at;
}

/// Newton's method for s: s + root^T f(b + root s) is the gradient of a convex function, whose second derivative is 1
/// and more. A step is halved until the slope along it hardly rises.
RimProblem::State RimProblem::without_friction(const VectorXd& b, const VectorXd& w) const {
  const double by_gap = back(contact_.stiffness() * contact_.gap() * VectorXd::Unit(b.size(), 0)).norm();
  State at = frictionless(b, solve_root(w - b));
  for (int i = 0; i < most_steps; ++i) {
    const VectorXd gradient = at.s + at.pushed;
    const double before = gradient.norm(), scale = at.s.norm() + at.pushed.norm() + by_gap;
    if (before <= rounding * scale) break;
    const VectorXd step = -curvature(at.touching).llt().solve(gradient);
    const double slope = gradient.dot(step);
    double length = 1;
    State there = frictionless(b, at.s + step);
    constexpr double little = 0.1;
    for (int j = 0; j < most_halvings && (there.s + there.pushed).dot(step) > -little * slope; ++j) {
      length /= 2;
      there = frictionless(b, at.s + length * step);
    }
    constexpr double near = 1e-11;  // where only rounding is left to fall
    if (before <= near * scale && (there.s + there.pushed).norm() > 0.5 * before) break;
    at = std::move(there);
  }
  return at;
}

RimProblem::State RimProblem::rubbing(const VectorXd& b, VectorXd w) const {
  State at;
  at.w = std::move(w);
  at.touching = contact_.touching(at.w);
  at.forces = contact_.forces(at.touching, at.w);
  at.friction = rim_friction(contact_, at.touching, at.w);
  at.residual = at.w - b + (waves_->M * at.forces + waves_->M_tau * at.friction.forces) / area_;
  at.residual += more_.cwiseProduct(at.forces);
  return at;
}

MatrixXd RimProblem::jacobian(const State& at) const {
  MatrixXd J;
  if (is_diagonal_) {
    J = modulus() * (M_tau_ * at.friction.slopes);
    J += modulus() * waves_->M.diagonal().asDiagonal() * at.touching.share;
  } else {
    J = modulus() * waves_->M_tau * at.friction.slopes;
    J += modulus() * waves_->M * at.touching.share;
  }
  J += contact_.stiffness() * more_.asDiagonal() * at.touching.share;
  J.diagonal().array() += 1;
  return J;
}

/// Newton's method, whose steps are halved until the residual falls.
bool RimProblem::with_friction(const VectorXd& b, State& at) const {
  for (int i = 0; i < most_steps; ++i) {
    const double before = at.residual.norm(), scale = at.w.norm() + b.norm() + std::abs(contact_.gap());
    if (before <= rounding * scale) return true;
    const VectorXd step = -matrices::Lu(jacobian(at)).solve(at.residual);
    double length = 1;
    State there = rubbing(b, at.w + step);
    const auto falls = [&] { return there.residual.norm() < (1 - 0.1 * length) * before; };
    for (int j = 0; j < most_halvings && !falls(); ++j) {
      length /= 2;
      there = rubbing(b, at.w + length * step);
    }
    constexpr double near = 1e-12;  // where only rounding is left to fall
    if (!falls()) return before <= near * scale;
    at = std::move(there);
  }
  return false;
}

const RimSolution& RimProblem::solve(const VectorXd& c) const {
  if (is_solved_ && last_c_ == c) return last_;
  VectorXd start;
  if (last_c_.size() > 0 && last_.converged) start = last_.w + last_.w_by_c * (c - last_c_);
  last_ = solution(c, start);
  last_c_ = c;
  is_solved_ = true;
  return last_;
}

RimSolution RimProblem::solution(const VectorXd& c, const VectorXd& start) const {
  const Index n = waves_->n;
  VectorXd b = VectorXd::Zero(n);
  b.head(n_long()) = c / k_;
  MatrixXd rhs = MatrixXd::Zero(n, n_long() + 1);
  rhs.topLeftCorner(n_long(), n_long()).diagonal().setConstant(1 / k_);
  State at;
  RimSolution result;
  if (contact_.mu() > 0) {
    if (start.size() > 0) at = rubbing(b, start);
    if (start.size() == 0 || !with_friction(b, at)) {
      at = rubbing(b, without_friction(b, b).w);
      result.converged = with_friction(b, at);
    }
    if (at.friction.slips) rhs.rightCols(1) = -waves_->M_tau * at.friction.forces / (area_ * contact_.mu());
    rhs = matrices::Lu(jacobian(at)).solve(std::move(rhs));
  } else {
    at = without_friction(b, start.size() > 0 ? start : b);
    rhs = solve_root(rhs);
    curvature(at.touching).llt().solveInPlace(rhs);
    for (auto column : rhs.colwise()) column = forward(column);
  }
  result.w_by_c = rhs.leftCols(n_long());
  result.w_by_mu = rhs.rightCols(1);
  result.w = std::move(at.w);
  result.touching = std::move(at.touching);
  result.forces = std::move(at.forces);
  result.friction = std::move(at.friction);
  return result;
}

}  // namespace fastjoint::stage3
