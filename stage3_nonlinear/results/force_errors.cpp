// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/force_errors.hpp"

#include <algorithm>
#include <cmath>

#include "common/infinite.hpp"
#include "common/matrices/stiffness_error.hpp"

namespace fastjoint::stage3 {
namespace {

bool is_known(const PlateModel& plate) { return !plate.lower.empty() || plate.S_error.size() > 0; }

/// Errors of all forces by one plate, (n).
/// @param w (m + e + k, n) change of each force per unit of the force on each unknown.
VectorXd plate_errors(const PlateModel& plate, const Eigen::Ref<const MatrixXd>& w, const PlateState& state) {
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De, state.moments;
  const VectorXd& f = state.traction;
  if (plate.lower.empty()) return w.cwiseAbs().transpose() * (plate.S_error * u.cwiseAbs());
  constexpr double of_bound = 0.25;  // min error over the bound by energies
  const auto load = [&](const PlateDegree& at) -> VectorXd { return at.S * u + at.T * f + at.R * state.Lambda; };
  const Index n = std::ssize(plate.lower);
  VectorXd energy(n + 1);  // u . S u + 2 u . T f - f . C f at every degree
  Eigen::VectorXi p(n + 1);
  for (Index i = 0; i <= n; ++i) {
    const auto& at = i < n ? plate.lower[i] : static_cast<const PlateDegree&>(plate);
    energy[i] = u.dot(at.S * u) + 2 * u.dot(at.T * f) - f.dot(at.C * f);
    p[i] = at.degree;
  }
  const double fall = std::abs(energy[n - 1] - energy[n]);
  const double more = fall > 0 ? matrices::extrapolated_error(energy, p) / fall : 1;
  const VectorXd change = w.transpose() * (load(plate.lower.back()) - load(plate));
  const MatrixXd by_w = (plate.lower.back().S - plate.S) * w;
  const VectorXd fall_by_w = w.cwiseProduct(by_w).colwise().sum().transpose().cwiseAbs();
  return more * (change.cwiseAbs2() + of_bound * of_bound * fall * fall_by_w).cwiseSqrt();
}

}  // namespace

ForceErrors::ForceErrors(const JointModel& joint, const JointEquations& equations)
    : joint_(joint), equations_(equations), are_known_(std::ranges::all_of(joint.plates, is_known)) {}

VectorXd ForceErrors::at(const SolvedPoint& point, const JointState& state) const {
  Slopes slopes = point.estimated_slopes();
  slopes.no_column.clear();  // errors of S have no resultant on a floating plate, so that these columns do not count
  const MatrixXd A = point.of_magnitudes(slopes);
  const MatrixXd w = equations_.system->displaced(A.transpose());
  VectorXd result = VectorXd::Zero(A.rows());
  for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
    const PlateModel& plate = joint_.plates[i];
    result += plate_errors(plate, w.middleRows(joint_.offset(i), plate.n_unknowns()), state.plates[i]);
  }
  if (point.check().at_limit_load()) result.setConstant(infinite);
  for (const Index row : slopes.no_row)
    if (row < equations_.n_plane_rows()) result[row / joint_.n_directions()] = infinite;
  return result;
}

}  // namespace fastjoint::stage3
