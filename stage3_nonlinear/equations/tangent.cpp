// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/tangent.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/matrices/decompositions.hpp"
#include "stage3_nonlinear/equations/tangent_factor.hpp"

namespace fastjoint::stage3 {
namespace {

/// Reciprocal condition, with columns scaled, below which a tangent is singular.
constexpr double singular_tangent = 1e-10;

/// Divides the columns of A whose largest entry exceeds 1 by it, and returns what they were divided by. Small ones
/// stay: contact coordinates have a tangent of order 1, and what is small in it is lack of stiffness.
VectorXd scale_columns(MatrixXd& A) {
  VectorXd scale = A.cwiseAbs().colwise().maxCoeff().transpose().cwiseMax(1.0);
  A.array().rowwise() /= scale.transpose().array();
  return scale;
}

/// The motion that the tangent does not resist, and the planes that take part in it by more than a share of its largest
/// entry: those that are open, and those that bear on a level piece of their law. A law that rises again behind a level
/// piece, as after a slip, is no limit.
/// @param J With columns divided by `scale`.
Mechanism mechanism(const JointEquations& equations, const ContactState& state, const TangentFactor& J,
                    const VectorXd& scale) {
  constexpr double moves = 1e-6, level = 1e-12, far = 1e6;
  const MatrixXd dc = scale.cwiseInverse().asDiagonal() * J.free_motions(singular_tangent);
  const MatrixXd delta = state.times(dc.transpose(), state.ddelta).transpose();  // the blocks are symmetric
  Mechanism result{{}, {}, equations.system.D_delta * delta.rightCols(1)};
  const Index a = state.direction.rows();
  for (Index j = 0; j < std::ssize(state.dF.along); ++j) {
    if (!(delta.middleRows(j * a, a).norm() > moves * delta.norm())) continue;
    if (state.F.segment(j * a, a).isZero(0)) {
      result.open.push_back(j);
    } else if (const Contact& at = equations.contacts[j];
               state.dF.along[j] <= level &&
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

/// Eigenvalues of the tangent whose real part is less than `least`.
Index soft_modes(const CondensedSystem& system, const ContactState& state, double least) {
  if (system.has_friction()) {
    return (matrices::eigenvalues(tangent(system, state)).real().array() < least).count();
  }
  // P S P + dF/dc with P^2 = d delta/dc is symmetric and similar to the tangent (docs/theory.md, section 9.3).
  Blocks root{state.ddelta.along.cwiseSqrt(), state.ddelta.across.cwiseSqrt()};
  for (const auto& rim : state.ddelta.rims) root.rims.emplace_back(rim.cwiseSqrt());
  const MatrixXd PS = state.times(system.S_ud, root).transpose();
  const MatrixXd A = state.times(PS, root) + state.times(MatrixXd::Identity(PS.rows(), PS.rows()), state.dF);
  return (matrices::symmetric_eigenvalues(A).array() < least).count();
}

/// A norm of the friction matrix H E, which none of its eigenvalues exceeds.
double friction_norm(const MatrixXd& H) {
  return std::min(H.cwiseAbs().rowwise().sum().maxCoeff(), H.cwiseAbs().colwise().sum().maxCoeff());
}

/// True if the tangent J of laws that rise has no eigenvalue that `soft_modes` would count, as it surely has not where
/// the symmetric part of its product with the metric is positive definite: it is similar to M^1/2 (M^-1 J) M^1/2.
bool surely_stable(const JointEquations& equations, const MatrixXd& J) {
  if (equations.metric.size() == 0) return false;
  const MatrixXd H = gradient(equations, J + singular_tangent * MatrixXd::Identity(J.rows(), J.cols()));
  return matrices::is_positive_definite(H + H.transpose());
}

/// True if the tangent is W times a symmetric Hessian H: without friction, rims of contact and laws that fall.
bool has_hessian(const JointEquations& equations) {
  return equations.metric.size() > 0 && !equations.system.has_friction() && equations.rims.empty();
}

/// Reciprocal condition of H above which no tangent is near singular.
constexpr double surely_regular = 1e3 * singular_tangent;

/// Inverse of the tangent, I + H^-1 d delta / dc (docs/theory.md, section 8.4), where it has a Hessian
/// H that is surely regular.
std::optional<MatrixXd> inverse_tangent(const JointEquations& equations, const ContactState& state) {
  if (!has_hessian(equations)) return std::nullopt;
  const MatrixXd H = hessian(equations, state);
  const auto inverse = matrices::inverse_of_positive(H);
  const auto norm = [](const MatrixXd& A) { return A.cwiseAbs().colwise().sum().maxCoeff(); };
  if (!inverse || !(surely_regular * norm(H) * norm(*inverse) < 1)) return std::nullopt;
  MatrixXd J = state.times(*inverse, state.ddelta);
  J.diagonal().array() += 1;
  return J;
}

/// Least squares where J is singular: what is left of the right-hand side has no solution near, and forces that the
/// free motions of the unknowns change have no derivative.
Slopes solve_singular(const TangentFactor& factor, const MatrixXd& J, const MatrixXd& F_c, const MatrixXd& rhs) {
  constexpr double left = 1e-6;  // beyond what the solver's tolerance leaves out of balance
  const auto [dc, free] = factor.solve_singular(rhs, singular_tangent);
  Slopes slopes{F_c * dc, dc, {}, {}};
  const MatrixXd rest = J * dc - rhs, F_free = F_c * free;
  for (Index i = 0; i < rhs.cols(); ++i)
    if (rest.col(i).norm() > left * rhs.col(i).norm()) slopes.no_column.push_back(i);
  for (Index i = 0; i < F_free.rows(); ++i)
    if (F_free.row(i).norm() > left) slopes.no_row.push_back(i);
  return slopes;
}

}  // namespace

std::optional<double> self_locking(const CondensedSystem& system, const VectorXd& F) {
  if (system.friction.empty()) return std::nullopt;
  const MatrixXd H = system.friction_matrix(F);
  if (friction_norm(H) < 1) return std::nullopt;
  constexpr double real = 1e-9;  // imaginary part of a real eigenvalue, by rounding
  double largest = 0;
  const Eigen::VectorXcd values = matrices::eigenvalues(-H);
  for (const auto& value : values)
    if (std::abs(value.imag()) <= real * std::abs(value)) largest = std::max(largest, value.real());
  if (!(largest >= 1)) return std::nullopt;
  return 1 / largest;
}

TangentCheck check_tangent(const JointEquations& equations, const ContactState& state) {
  if (has_hessian(equations)) {
    const Eigen::LLT<MatrixXd> factor(hessian(equations, state));
    if (factor.info() == Eigen::Success && factor.rcond() > surely_regular) return {};
  }
  const CondensedSystem& system = equations.system;
  TangentCheck check;
  MatrixXd J = tangent(system, state);
  const VectorXd scale = scale_columns(J);
  if (const TangentFactor factor(J, equations.rim_sizes()); !(factor.least_stretch() > singular_tangent)) {
    Mechanism found = mechanism(equations, state, factor, scale);
    if (!found.open.empty() || !found.level.empty()) {
      check.mechanism = std::move(found);
      return check;
    }
  }
  // Only large friction makes a joint of rising laws unstable.
  const bool falls = (state.dF.along.array() < 0).any();
  MatrixXd friction = system.friction_matrix(state.F);
  add_shear_slopes(system, state, friction);
  if (falls || (friction_norm(friction) >= 1 && !surely_stable(equations, J * scale.asDiagonal())))
    check.unstable = soft_modes(system, state, -singular_tangent);
  check.locking = self_locking(system, state.F);
  return check;
}

std::vector<Index> level_planes(const JointEquations& equations, const VectorXd& c) {
  constexpr double nearly_level = 1e-3, nearly_singular = 1e-4;  // where a try that failed ended
  ContactState state = contact_state(equations, c);
  std::vector<Index> level;
  for (Index j = 0; j < equations.n_planes(); ++j) {
    const Index a = equations.n_directions();
    const bool open = state.F.segment(j * a, a).isZero(0);
    const Contact& contact = equations.contacts[j];
    const double amount = c.segment(j * a, a).norm();
    // A law that rises again behind a level piece, as after a slip, is no limit.
    const bool rises_again = std::ranges::any_of(std::array{1.5, 3.0, 10.0, 100.0}, [&](double further) {
      return contact.law->at(further * amount, contact.stiffness, contact.clearance).dF > nearly_level;
    });
    if (state.spent != j && (open || state.dF.along[j] > nearly_level || rises_again)) continue;
    level.push_back(j);
    state.dF.along[j] = std::min(state.dF.along[j], 0.0);
  }
  if (state.spent || soft_modes(equations.system, state, nearly_singular) > 0) return level;
  return {};
}

std::vector<Index> planes_that_may_snap(const JointEquations& equations) {
  std::vector<Index> falling;
  MatrixXd S = equations.system.S_ud;
  const Index n = equations.n_planes(), a = equations.n_directions();
  for (Index j = 0; j < n; ++j) {
    const Law& law = *equations.contacts[j].law;
    if (law.rises()) continue;
    falling.push_back(j);
    for (Index d = 0; d < a; ++d) S(j * a + d, j * a + d) += law.least_slope();
  }
  if (falling.empty() || matrices::is_positive_definite(S)) return {};
  return falling;
}

Slopes implicit_slopes(const JointEquations& equations, const ContactState& state,
                       const std::optional<MatrixXd>& given) {
  if (const auto inverse = inverse_tangent(equations, state)) {
    const MatrixXd dc = given ? *inverse * *given : *inverse;
    return {-state.times(dc.transpose(), state.dF).transpose(), -dc, {}, {}};  // the blocks are symmetric
  }
  MatrixXd J = tangent(equations.system, state);
  const VectorXd scale = scale_columns(J);
  const TangentFactor factor(J, equations.rim_sizes());
  if (factor.least_stretch() > singular_tangent) {
    if (!given) {  // from the few forces back
      const MatrixXd F_c = state.times(MatrixXd::Identity(equations.n_plane_rows(), J.rows()), state.dF);
      const MatrixXd back = factor.solve_transposed(scale.cwiseInverse().asDiagonal() * F_c.transpose());
      return {-back.transpose(), {}, {}, {}};
    }
    const MatrixXd dc = scale.cwiseInverse().asDiagonal() * factor.solve(*given);
    return {-state.times(dc.transpose(), state.dF).transpose(), -dc, {}, {}};
  }
  const MatrixXd F_c = state.times(MatrixXd::Identity(J.rows(), J.rows()), state.dF);
  Slopes slopes = solve_singular(factor, J, F_c * scale.cwiseInverse().asDiagonal(),
                                 -given.value_or(MatrixXd::Identity(J.rows(), J.rows())));
  slopes.c = scale.cwiseInverse().asDiagonal() * slopes.c;
  return slopes;
}

void bear(const JointEquations& equations, ContactState& state) {
  constexpr int most_tries = 8;
  const CondensedSystem& system = equations.system;
  for (int i = 0; i < most_tries && !system.friction.empty(); ++i) {
    const VectorXd before = system.E * state.F;
    state.F = implicit_slopes(equations, state, -system.q).F;
    if (i > 0 && ((system.E * state.F).array() * before.array() >= 0).all()) return;
  }
}

MatrixXd of_amounts(const Slopes& slopes, const ContactState& state, const VectorXd& c) {
  const Index a = state.direction.rows(), n = state.direction.cols();
  MatrixXd result = slopes.F.topRows(n);
  if (a > 1) {
    for (Index j = 0; j < result.rows(); ++j) {
      const auto block = slopes.F.middleRows(j * a, a);
      result.row(j) = state.direction.col(j).transpose() * block;
      // Without load there is no direction; the amount then grows whatever the direction is.
      if (c.segment(j * a, a).isZero(0)) result.row(j) = block.colwise().norm();
    }
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  for (const Index i : slopes.no_column) result.col(i).setConstant(none);
  for (const Index i : slopes.no_row)
    if (i < n * a) result.row(i / a).setConstant(none);
  return result;
}

}  // namespace fastjoint::stage3
