// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/sensitivity.hpp"

#include <algorithm>

#include "stage3_nonlinear/equations/rim_friction.hpp"
#include "stage3_nonlinear/equations/solved_point.hpp"

namespace fastjoint::stage3 {
namespace {

/// Derivatives dF and d delta at fixed c by the clearances, then by the numbers of the laws, each of shape (r, n +
/// l).
std::pair<MatrixXd, MatrixXd> law_changes(const JointEquations& equations, const JointNumbers& numbers,
                                          const ContactState& state, const VectorXd& c) {
  const Index a = state.direction.rows(), n = state.direction.cols();
  MatrixXd F = MatrixXd::Zero(c.size(), n + std::ssize(numbers.law));
  MatrixXd delta = F;
  for (Index j = 0; j < n; ++j) {
    const Contact& contact = equations.contacts[j];
    const VectorXd here = c.segment(j * a, a);
    if (here.isZero(0) || contact.is_pulled_open(here)) continue;
    const auto slopes = contact.law->slopes(here.norm(), contact.stiffness, contact.clearance);
    for (Index i = 0; i < std::ssize(slopes); ++i) {
      const Index column = i == 0 ? j : n + numbers.first_of_law[j] + i - 1;
      F.block(j * a, column, a, 1) = slopes[i].F * state.direction.col(j);
      delta.block(j * a, column, a, 1) = slopes[i].delta * state.direction.col(j);
    }
  }
  return {F, delta};
}

/// Changes of the residual by each mu, (n a, f).
MatrixXd friction_changes(const CondensedSystem& system, const std::vector<FrictionHole>& holes, const VectorXd& F) {
  MatrixXd changes = MatrixXd::Zero(F.size(), std::ssize(holes));
  if (system.friction.empty()) return changes;  // OpenBLAS complains on stderr about a matrix without rows
  const VectorXd b = system.E * F;
  for (Index i = 0; i < changes.cols(); ++i)
    for (const auto& row : holes[i].rows)
      changes.col(i) += std::abs(b[row.at]) * (b[row.at] < 0 ? row.minus : row.plus);
  return changes;
}

/// Changes of the residual by the coefficient of each rim of contact with friction, (r, columns): its shears are
/// proportional to it where the rim slips, and do not know it where it sticks.
MatrixXd shear_changes(const JointEquations& equations, const ContactState& state) {
  const MatrixXd& H = equations.system.H_shear;
  MatrixXd changes(state.F.size(), 0);
  Index moment = equations.n_plane_rows(), shear = 0;
  for (const RimContact& rim : equations.rims) {
    const VectorXd m = state.delta.segment(moment, rim.size());
    moment += rim.size();
    if (rim.mu() == 0) continue;
    const RimFriction friction = rim_friction(rim, rim.touching(m), m);
    const Index n = friction.forces.size();
    changes.conservativeResize(Eigen::NoChange, changes.cols() + 1);
    changes.rightCols(1).setZero();
    if (friction.slips) changes.rightCols(1) = H.middleCols(shear, n) * friction.forces / rim.mu();
    shear += n;
  }
  return changes;
}

/// Changes of the residual by the gap of each rim of contact, (r, g): it acts as its first moment does, but for that
/// moment itself.
MatrixXd gap_changes(const JointEquations& equations, const ContactState& state) {
  const Index planes = equations.n_plane_rows();
  MatrixXd by_shear = MatrixXd::Zero(state.F.size(), state.F.size());
  add_shear_slopes(equations.system, state, by_shear);
  Index first = planes;
  MatrixXd changes = MatrixXd::Zero(state.F.size(), std::ssize(equations.rims));
  for (Index i = 0; i < changes.cols(); ++i) {
    const RimContact& rim = equations.rims[i];
    changes.col(i).segment(first, rim.size()) = -rim.stiffness() * state.dF.rims[i].col(0);
    changes.col(i) -= rim.stiffness() * by_shear.col(first);
    first += rim.size();
  }
  return changes;
}

/// Changes of the residual at fixed c by all numbers, (r, columns): load factor, clearances, laws, mu, forces,
/// displacements, gaps.
/// @param F, delta Those of law_changes.
MatrixXd residual_changes(const JointNumbers& numbers, const SolvedPoint& point, const MatrixXd& F,
                          const MatrixXd& delta) {
  const JointEquations& equations = point.equations();
  const CondensedSystem& system = equations.system;
  const ContactState& state = point.state();
  const double load_factor = point.load_factor();
  MatrixXd by_law = F + system.S_ud * delta;
  if (!system.friction.empty()) by_law += system.friction_matrix(state.F) * F;
  const MatrixXd by_cosine = friction_changes(system, numbers.friction, state.F);
  const MatrixXd by_shear = shear_changes(equations, state);
  const MatrixXd by_gap = gap_changes(equations, state);
  MatrixXd all(F.rows(), numbers.n_derivatives());
  all << -system.q_at(load_factor), by_law, by_cosine, by_shear, -load_factor * numbers.q_force_at(load_factor),
      -load_factor * numbers.q_displacement, by_gap;
  return all;
}

/// Slopes of a solution by all numbers, with what these do at fixed c.
/// @param all_delta If not null, also of delta, (r, columns).
Slopes all_slopes(const JointNumbers& numbers, const SolvedPoint& point, MatrixXd* all_delta) {
  const auto [F, delta] = law_changes(point.equations(), numbers, point.state(), point.c());
  Slopes slopes = point.slopes(residual_changes(numbers, point, F, delta));
  slopes.F.middleCols(1, F.cols()) += F;
  if (all_delta) {
    *all_delta = point.beyond().times(slopes.c.transpose(), point.beyond().ddelta).transpose();
    all_delta->middleCols(1, F.cols()) += delta;
  }
  return slopes;
}

}  // namespace

StateSlopes state_slopes(const JointNumbers& numbers, const SolvedPoint& point) {
  MatrixXd delta;
  const Slopes slopes = all_slopes(numbers, point, &delta);
  return {slopes.F, delta, slopes.no_column};
}

Sensitivity sensitivity(const JointNumbers& numbers, const SolvedPoint& point) {
  const MatrixXd dF = point.of_amounts(all_slopes(numbers, point, nullptr));
  Index column = 0;
  const auto next = [&](Index count) -> MatrixXd {
    column += count;
    return dF.middleCols(column - count, count);
  };
  return {.load_factor = next(1),
          .clearance = next(point.equations().n_planes()),
          .law = next(std::ssize(numbers.law)),
          .mu = next(std::ssize(numbers.friction) + std::ssize(numbers.shears)),
          .force = next(numbers.q_force.cols()),
          .displacement = next(numbers.q_displacement.cols()),
          .gap = next(std::ssize(numbers.gap))};
}

}  // namespace fastjoint::stage3
