// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/stability.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

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

TangentCheck check_tangent(const JointEquations& equations, const ContactState& state, const TangentFactor& factor,
                           const VectorXd& scale) {
  const CondensedSystem& system = equations.system;
  TangentCheck check;
  if (!(factor.least_stretch() > singular_tangent)) {
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
  if (falls || (friction_norm(friction) >= 1 && !surely_stable(equations, factor.matrix() * scale.asDiagonal())))
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

}  // namespace fastjoint::stage3
