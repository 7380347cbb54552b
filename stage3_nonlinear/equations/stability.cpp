// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

/// The motion without stiffness, and the planes that move by more than a small fraction of its norm: those that are
/// open, and those that bear on a horizontal piece of their law. A law that rises again after a horizontal piece, as
/// after a slip, is no limit.
Mechanism mechanism(const JointEquations& equations, const ContactState& state, const TangentFactor& J) {
  constexpr double moves = 1e-6, level = 1e-12, far = 1e6;
  const MatrixXd delta = state.product(&Response::ddelta, J.free_motions());
  Mechanism result{{}, {}, equations.system->displaced(delta.rightCols(1))};
  const Index a = state.direction.rows();
  for (Index j = 0; j < equations.n_planes(); ++j) {
    if (!(delta.middleRows(j * a, a).norm() > moves * delta.norm())) continue;
    if (state.F.segment(j * a, a).isZero(0)) {
      result.open.push_back(j);
    } else if (const Contact& at = equations.contacts[j];
               state.along(&Response::dF, j) <= level &&
               at.law->at(far * (state.F + at.stiffness * state.delta).norm(), at.stiffness, at.clearance).F <=
                   (1 + far * level) * state.F.segment(j * a, a).norm()) {
      result.level.push_back(j);
    }
  }
  Index at = 0;
  result.motion.cwiseAbs().maxCoeff(&at);
  if (result.motion[at] != 0) result.motion /= result.motion[at];
  return result;
}

/// Symmetric square root of a symmetric matrix without negative eigenvalues.
MatrixXd square_root(const MatrixXd& A) {
  if (A.isDiagonal(0)) return A.cwiseMax(0).cwiseSqrt();
  const auto eigen = matrices::symmetric_eigen(A);
  return eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.vectors.transpose();
}

/// Number of eigenvalues of the tangent with a real part below a limit.
Index soft_modes(const JointEquations& equations, const ContactState& state, double limit) {
  const CondensedSystem& system = *equations.system;
  if (equations.has_friction) return (matrices::eigenvalues(tangent(system, state)).real().array() < limit).count();
  // P S P + dF/dc with P^2 = d delta/dc is symmetric and similar to the tangent (docs/theory.md, section 9.3).
  ContactState root = state;
  for (Response& part : root.parts) part.ddelta = square_root(part.ddelta);
  const MatrixXd PS = root.times(system.S_ud, &Response::ddelta).transpose();
  MatrixXd A = root.times(PS, &Response::ddelta);
  for (const PlacedResponse& part : state.parts) A.block(part.row, part.row, part.F.size(), part.F.size()) += part.dF;
  return (matrices::symmetric_eigenvalues(A).array() < limit).count();
}

/// A norm of the friction matrix H E, an upper bound of its eigenvalues.
double friction_norm(const MatrixXd& H) {
  return std::min(H.cwiseAbs().rowwise().sum().maxCoeff(), H.cwiseAbs().colwise().sum().maxCoeff());
}

/// True if the tangent J at a state certainly has no eigenvalue that `soft_modes` would count. Sufficient for laws that
/// rise is that the symmetric part of d delta/dc^T J is positive definite, and with it that of the tangent
/// stiffness J (d delta/dc)^-1. Planes of rigid laws do not move and are left out.
bool surely_stable(const JointEquations& equations, const ContactState& state) {
  if (!equations.rises) return false;
  const MatrixXd J = tangent(*equations.system, state);
  constexpr double rigid = 1e-12;
  const Index n = J.rows();
  const MatrixXd ddelta = state.times(MatrixXd::Identity(n, n), &Response::ddelta);
  std::vector<Index> moves;
  for (Index i = 0; i < n; ++i) {
    const Index entry = equations.entry_of(i);
    if (ddelta(i, i) * equations.system->stiffness[entry] > rigid) {
      moves.push_back(i);
    } else if (!ddelta.row(i).isZero(0) || (J.col(i) - VectorXd::Unit(n, i)).lpNorm<Eigen::Infinity>() > rigid) {
      return false;
    }
  }
  MatrixXd A = state.times(J.transpose(), &Response::ddelta);  // the transpose
  A = (A(moves, moves) + A(moves, moves).transpose()).eval();
  const VectorXd scale =
      A.diagonal().cwiseAbs().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  A = (scale.asDiagonal() * A * scale.asDiagonal()).eval();
  A.diagonal().array() += singular_tangent;
  return matrices::is_positive_definite(std::move(A));
}

/// Sets a positive slope of the force of a plane along c, and that of its friction, to zero.
void remove_stiffness(const JointEquations& equations, ContactState& state, Index plane) {
  const Index a = state.direction.rows(), i = state.part_of(plane * a);
  PlacedResponse& part = state.parts[i];
  const Index row = plane * a - part.row;
  const double rise = std::max(state.along(&Response::dF, plane), 0.0);
  part.dF.block(row, row, a, a) -= rise * state.direction.col(plane) * state.direction.col(plane).transpose();
  const MatrixXd by_force = equations.interfaces[i].interface->friction_by_force(part.F);
  if (by_force.size() > 0) part.dLambda = by_force * part.dF;
}

}  // namespace

std::optional<double> self_locking(const JointEquations& equations, const VectorXd& F) {
  if (!equations.has_cosine_friction) return std::nullopt;
  const MatrixXd H = equations.friction_matrix(F);
  if (friction_norm(H) < 1) return std::nullopt;
  constexpr double real = 1e-9;  // max imaginary part of a real eigenvalue, by rounding
  double largest = 0;
  const Eigen::VectorXcd values = matrices::eigenvalues(-H);
  for (const auto& value : values)
    if (std::abs(value.imag()) <= real * std::abs(value)) largest = std::max(largest, value.real());
  if (!(largest >= 1)) return std::nullopt;
  return 1 / largest;
}

TangentCheck check_tangent(const JointEquations& equations, const ContactState& state, const TangentFactor& factor) {
  TangentCheck check;
  if (factor.is_singular()) {
    Mechanism found = mechanism(equations, state, factor);
    if (!found.open.empty() || !found.level.empty()) {
      check.mechanism = std::move(found);
      return check;
    }
  }
  // A joint of rising laws is unstable only by friction, and by cosine friction only if it is large.
  bool falls = false;
  for (Index j = 0; j < equations.n_planes(); ++j) falls = falls || state.along(&Response::dF, j) < 0;
  const bool rims_rub = std::ranges::any_of(equations.rims, [](const auto& rim) { return rim->contact().mu() > 0; });
  const bool in_doubt =
      rims_rub || (equations.has_cosine_friction && friction_norm(equations.friction_matrix(state.F)) >= 1);
  constexpr Index large = 400;  // from here on all eigenvalues would take longer than the solution
  if (in_doubt && state.F.size() >= large) {
    check.unstable = factor.is_negative() ? 1 : 0;
  } else if (falls || (in_doubt && !surely_stable(equations, state))) {
    check.unstable = soft_modes(equations, state, -singular_tangent);
  }
  check.locking = self_locking(equations, state.F);
  return check;
}

std::vector<Index> level_planes(const JointEquations& equations, const VectorXd& c) {
  constexpr double nearly_level = 1e-3, nearly_singular = 1e-4;  // at the last iterate of a failed try
  ContactState state = contact_state(equations, c);
  const Index failed = state.failed ? equations.entry_of(*state.failed) : -1;
  std::vector<Index> level;
  for (Index j = 0; j < equations.n_planes(); ++j) {
    const Index a = equations.n_directions();
    const bool open = state.F.segment(j * a, a).isZero(0);
    const Contact& contact = equations.contacts[j];
    if (contact.law->rises() && std::isinf(contact.law->max_force()) && failed != j) continue;  // soft, without limit
    const double length = c.segment(j * a, a).norm();
    // A law that rises again after a horizontal piece, as after a slip, is no limit.
    const bool rises_again = std::ranges::any_of(std::array{1.5, 3.0, 10.0, 100.0}, [&](double further) {
      return contact.law->at(further * length, contact.stiffness, contact.clearance).dF > nearly_level;
    });
    if (failed != j && (open || state.along(&Response::dF, j) > nearly_level || rises_again)) continue;
    level.push_back(j);
    remove_stiffness(equations, state, j);
  }
  if (state.failed || soft_modes(equations, state, nearly_singular) > 0) return level;
  return {};
}

std::vector<Index> planes_that_may_snap(const JointEquations& equations) {
  std::vector<Index> falling;
  const Index n = equations.n_planes(), a = equations.n_directions();
  for (Index j = 0; j < n; ++j)
    if (!equations.contacts[j].law->rises()) falling.push_back(j);
  if (falling.empty()) return {};
  MatrixXd S = equations.system->S_ud;
  for (const Index j : falling) S.diagonal().segment(j * a, a).array() += equations.contacts[j].law->min_slope();
  if (matrices::is_positive_definite(std::move(S))) return {};
  return falling;
}

}  // namespace fastjoint::stage3
