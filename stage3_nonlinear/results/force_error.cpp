// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/force_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/matrices/stiffness_error.hpp"
#include "stage3_nonlinear/equations/implicit_slopes.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// u . S u + 2 u . T f - f . C f at every degree, (np).
VectorXd energies(const PlateDegrees& degrees, const VectorXd& u, const VectorXd& f) {
  VectorXd values(degrees.p.size());
  for (Index i = 0; i < values.size(); ++i)
    values[i] = u.dot(degrees.S[i] * u) + 2 * u.dot(degrees.T[i] * f) - f.dot(degrees.C[i] * f);
  return values;
}

bool is_known(const PlateModel& plate) { return plate.degrees.p.size() > 1 || plate.S_error.allFinite(); }

/// Part of a plate in the errors of all forces, (n).
/// @param w (n, m + e) change of each force per force on each unknown.
VectorXd plate_errors(const PlateModel& plate, const MatrixXd& w, const PlateState& state) {
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De;
  const PlateDegrees& degrees = plate.degrees;
  const auto n = degrees.S.size();
  if (n < 2) return w.cwiseAbs() * (plate.S_error * u.cwiseAbs());
  constexpr double least = 0.25;  // of the bound
  const auto load = [&](std::size_t i) -> VectorXd {
    return degrees.S[i] * u + degrees.T[i] * state.traction + degrees.R[i] * state.Lambda;
  };
  const VectorXd energy = energies(degrees, u, state.traction);
  const double fall = std::abs(energy[energy.size() - 2] - energy[energy.size() - 1]);
  const double more = fall > 0 ? matrices::extrapolated_error(energy, degrees.p) / fall : 1;
  const MatrixXd dS = degrees.S[n - 2] - degrees.S[n - 1];
  const VectorXd change = w * (load(n - 2) - load(n - 1));
  const VectorXd fall_by_w = (w * dS).cwiseProduct(w).rowwise().sum().cwiseAbs();
  return more * (change.cwiseAbs2() + least * least * fall * fall_by_w).cwiseSqrt();
}

/// Errors of the forces of one increment, (n).
VectorXd errors(const JointModel& joint, const JointEquations& equations, const PathStep& step,
                const JointState& solution) {
  const VectorXd c = coordinates(equations.contacts, step.F, step.delta);
  ContactState state = contact_state(equations.contacts, c);
  if (equations.system.has_friction() && state.F.isZero(0)) bear(equations, state);
  Slopes slopes = implicit_slopes(equations.system, state, equations.system.D_delta.transpose());
  slopes.no_column.clear();  // errors of S exert no net force on a floating plate, so that these columns do not count
  const MatrixXd w = of_amounts(slopes, state, c);
  VectorXd result = VectorXd::Zero(w.rows());
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateModel& plate = joint.plates[i];
    result += plate_errors(plate, w.middleCols(joint.offset(i), plate.n_unknowns()), solution.plates[i]);
  }
  if (step.check.at_limit_load()) result.setConstant(infinite);
  for (const Index row : slopes.no_row) result[row / joint.n_directions()] = infinite;
  return result;
}

}  // namespace

std::optional<MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                                     const std::vector<JointState>& states) {
  if (!std::all_of(joint.plates.begin(), joint.plates.end(), is_known)) return std::nullopt;
  MatrixXd result(std::ssize(path.steps), joint.n_planes());
  for (std::size_t i = 0; i < path.steps.size(); ++i)
    result.row(i) = errors(joint, equations, path.steps[i], states[i]).transpose();
  return result;
}

}  // namespace fastjoint::stage3
