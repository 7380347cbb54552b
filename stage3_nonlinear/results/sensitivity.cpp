// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/matrices/stiffness_error.hpp"
#include "stage3_nonlinear/equations/rim_friction.hpp"
#include "stage3_nonlinear/equations/tangent.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

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
MatrixXd residual_changes(const JointEquations& equations, const JointNumbers& numbers, const ContactState& state,
                          const MatrixXd& F, const MatrixXd& delta, double load_factor) {
  const CondensedSystem& system = equations.system;
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
Slopes all_slopes(const JointEquations& equations, const JointNumbers& numbers, const PathStep& step, const VectorXd& c,
                  ContactState state, MatrixXd* all_delta) {
  const auto [F, delta] = law_changes(equations, numbers, state, c);
  const MatrixXd residual = residual_changes(equations, numbers, state, F, delta, step.load_factor);
  if (equations.system.has_friction() && state.F.isZero(0)) bear(equations, state);
  Slopes slopes = implicit_slopes(equations, state, residual);
  slopes.F.middleCols(1, F.cols()) += F;
  if (all_delta) {
    *all_delta = state.times(slopes.c.transpose(), state.ddelta).transpose();
    all_delta->middleCols(1, F.cols()) += delta;
  }
  return slopes;
}

bool is_known(const PlateModel& plate) { return plate.degrees.p.size() > 1 || plate.S_error.allFinite(); }

/// Changes of the plates' stiffness with the last degree, over the shear planes: D_delta^T dS D_delta of each, its
/// lower triangle with half the diagonal, (n a, n a); empty of a plate of one degree.
std::vector<MatrixXd> stiffness_changes(const JointModel& joint, const CondensedSystem& system) {
  std::vector<MatrixXd> changes;
  Index moment = joint.n_planes() * joint.n_directions();
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const auto& S = plate.degrees.S;
    const Index m = plate.first_moment(), k = plate.n_unknowns() - m;
    MatrixXd& change = changes.emplace_back();
    if (S.size() < 2) continue;
    const MatrixXd dS = S[S.size() - 2] - S.back();
    const auto D = system.D_delta.middleRows(joint.offset(i), m);  // behind them moments are unknowns themselves
    change = D.transpose() * (dS.topLeftCorner(m, m) * D);
    if (k > 0) {
      const MatrixXd mixed = D.transpose() * dS.topRightCorner(m, k);
      change.middleCols(moment, k) += mixed;
      change.middleRows(moment, k) += mixed.transpose();
      change.block(moment, moment, k, k) += dS.bottomRightCorner(k, k);
    }
    moment += k;
    change.diagonal() /= 2;
  }
  return changes;
}

/// Part of a plate in the errors of all forces, (n).
/// @param A  (n, n a) change of each force per rise of the residual of each plane; w = A D^T.
/// @param D  (m + e, n a) rows of D_delta. @param dS The plate's stiffness_changes.
VectorXd plate_errors(const PlateModel& plate, const MatrixXd& A, const Eigen::Ref<const MatrixXd>& D,
                      const MatrixXd& dS, const PlateState& state) {
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De, state.moments;
  const VectorXd& f = state.traction;
  const PlateDegrees& degrees = plate.degrees;
  const auto n = degrees.S.size();
  if (n < 2) return (A * D.transpose()).cwiseAbs() * (plate.S_error * u.cwiseAbs());
  constexpr double least = 0.25;                     // of the bound
  const auto load = [&](Index before) -> VectorXd {  // at a degree before the last
    const auto R = degrees.R.rbegin() + before;
    return degrees.S[n - 1 - before] * u + degrees.T[n - 1 - before] * f + *R * state.Lambda;
  };
  VectorXd energy(degrees.p.size());  // u . S u + 2 u . T f - f . C f at every degree
  for (Index i = 0; i < std::ssize(energy); ++i)
    energy[i] = u.dot(degrees.S[i] * u) + 2 * u.dot(degrees.T[i] * f) - f.dot(degrees.C[i] * f);
  const double fall = std::abs(energy[energy.size() - 2] - energy[energy.size() - 1]);
  const double more = fall > 0 ? matrices::extrapolated_error(energy, degrees.p) / fall : 1;
  const VectorXd change = A * (D.transpose() * (load(1) - load(0)));
  const MatrixXd A_dS = A * dS.triangularView<Eigen::Lower>();
  const VectorXd fall_by_w = 2 * (A_dS.cwiseProduct(A) * VectorXd::Ones(A.cols())).cwiseAbs();
  return more * (change.cwiseAbs2() + least * least * fall * fall_by_w).cwiseSqrt();
}

/// Errors of the forces of one increment, (n).
/// @param dS Results of stiffness_changes.
VectorXd errors(const JointModel& joint, const JointEquations& equations, const std::vector<MatrixXd>& dS,
                const PathStep& step, const JointState& solution) {
  const VectorXd& c = step.c;
  ContactState state = contact_state(equations, c);
  if (equations.system.has_friction() && state.F.isZero(0)) bear(equations, state);
  Slopes slopes = implicit_slopes(equations, state);
  slopes.no_column.clear();  // errors of S exert no net force on a floating plate, so that these columns do not count
  const MatrixXd A = of_amounts(slopes, state, c);
  VectorXd result = VectorXd::Zero(A.rows());
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const auto D = equations.system.D_delta.middleRows(joint.offset(i), plate.n_unknowns());
    result += plate_errors(plate, A, D, dS[i], solution.plates[i]);
  }
  if (step.check.at_limit_load()) result.setConstant(infinite);
  for (const Index row : slopes.no_row)
    if (row < equations.n_plane_rows()) result[row / joint.n_directions()] = infinite;
  return result;
}

}  // namespace

StateSlopes state_slopes(const JointEquations& equations, const JointNumbers& numbers, const PathStep& step) {
  const VectorXd& c = step.c;
  const ContactState state = contact_state(equations, c);
  MatrixXd delta;
  const Slopes slopes = all_slopes(equations, numbers, step, c, state, &delta);
  return {slopes.F, delta, slopes.no_column};
}

Sensitivity sensitivity(const JointEquations& equations, const JointNumbers& numbers, const PathStep& step) {
  const VectorXd& c = step.c;
  const ContactState state = contact_state(equations, c);
  const MatrixXd dF = of_amounts(all_slopes(equations, numbers, step, c, state, nullptr), state, c);
  Index column = 0;
  const auto next = [&](Index count) -> MatrixXd {
    column += count;
    return dF.middleCols(column - count, count);
  };
  return {.load_factor = next(1),
          .clearance = next(std::ssize(equations.contacts)),
          .law = next(std::ssize(numbers.law)),
          .mu = next(std::ssize(numbers.friction) + std::ssize(numbers.shears)),
          .force = next(numbers.q_force.cols()),
          .displacement = next(numbers.q_displacement.cols()),
          .gap = next(std::ssize(equations.rims))};
}

std::optional<MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                                     const std::vector<JointState>& states) {
  if (!std::ranges::all_of(joint.plates, is_known)) return std::nullopt;
  const auto dS = stiffness_changes(joint, equations.system);
  MatrixXd result(std::ssize(path.steps), joint.n_planes());
  for (Index i = 0; i < std::ssize(path.steps); ++i)
    result.row(i) = errors(joint, equations, dS, path.steps[i], states[i]).transpose();
  return result;
}

}  // namespace fastjoint::stage3
