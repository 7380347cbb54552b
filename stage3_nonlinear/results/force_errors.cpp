// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/force_errors.hpp"

#include <algorithm>
#include <cmath>

#include "common/infinite.hpp"
#include "common/matrices/stiffness_error.hpp"

namespace fastjoint::stage3 {
namespace {

bool is_known(const PlateModel& plate) { return plate.degrees.p.size() > 1 || plate.S_error.allFinite(); }

/// Errors of all forces by one plate, (n).
/// @param w (m + e + k, n) change of each force per unit of the force on each unknown.
VectorXd plate_errors(const PlateModel& plate, const Eigen::Ref<const MatrixXd>& w, const PlateState& state) {
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De, state.moments;
  const VectorXd& f = state.traction;
  const PlateDegrees& degrees = plate.degrees;
  const auto n = degrees.S.size();
  if (n < 2) return w.cwiseAbs().transpose() * (plate.S_error * u.cwiseAbs());
  constexpr double of_bound = 0.25;                  // min error over the bound by energies
  const auto load = [&](Index before) -> VectorXd {  // at a degree before the last
    const auto R = degrees.R.rbegin() + before;
    return degrees.S[n - 1 - before] * u + degrees.T[n - 1 - before] * f + *R * state.Lambda;
  };
  VectorXd energy(degrees.p.size());  // u . S u + 2 u . T f - f . C f at every degree
  for (Index i = 0; i < std::ssize(energy); ++i)
    energy[i] = u.dot(degrees.S[i] * u) + 2 * u.dot(degrees.T[i] * f) - f.dot(degrees.C[i] * f);
  const double fall = std::abs(energy[energy.size() - 2] - energy[energy.size() - 1]);
  const double more = fall > 0 ? matrices::extrapolated_error(energy, degrees.p) / fall : 1;
  const VectorXd change = w.transpose() * (load(1) - load(0));
  const MatrixXd by_w = (degrees.S[n - 2] - degrees.S[n - 1]) * w;
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
